#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/soft/relax.hpp"
#include "figures/figure_files.hpp"
#include "figures/packings.hpp"
#include "figures/page.hpp"

namespace bernal::figures {

/// Sizes of table 2 of Zhao, Li & Liu (2007), and what is printed there for 10,000 spheres.
struct ZhaoSizes {
  std::string_view name;
  SceneSizes sizes;
  Draw draw = Draw::random;
  std::optional<double> phi = {}, coordination = {};
  double cost = 1;  ///< seconds of the published loop, over those of equal spheres
  int figure = 0;   ///< in which the packing is shown
};
/// Equal, two sizes, lognormal, arbitrary; then the lognormal sizes that the printed formula draws.
const std::vector<ZhaoSizes>& zhao_sizes();
inline constexpr std::size_t as_printed = 4;  ///< of these
inline constexpr double printed_sigma = 0.3;
/// Of the formula r = exp(sigma √(-ln t) sin 2πt'), which lacks a factor 2 beside the logarithm.
inline constexpr double drawn_sigma = 0.21213203435596426;

/// One packing of these sizes by relaxation.
struct ZhaoRun {
  std::size_t sizes = 0;
  RelaxMethod method = RelaxMethod::reference;
  int period = 0;  ///< sweeps between two growths; 0: T = 17 lg² N
  double phi0 = 0.86;
  int spheres = 0;
  std::uint64_t seed = 1;

  bool operator==(const ZhaoRun&) const = default;
};

/// All runs and what came of them.
struct ZhaoResults {
  std::vector<ZhaoRun> runs;
  std::vector<DonePacking> done;

  /// Those of runs that differ from this one by nothing but the seed.
  std::vector<const DonePacking*> of(ZhaoRun run) const;
  /// The numbers of spheres that runs like this one have, ascending.
  std::vector<int> counts(ZhaoRun run) const;
};
MeanOfSeeds phi_of(const std::vector<const DonePacking*>&);
MeanOfSeeds coordination_of(const std::vector<const DonePacking*>&);
MeanOfSeeds seconds_of(const std::vector<const DonePacking*>&);

/// Fixed periods of figure 5, which the text does not state.
inline constexpr int fixed_periods[] = {20, 100};

/// Drawn sizes against their density: figures 1 and 2, and their numbers as lines of CSV and of the page.
struct DrawnSizes {
  Files files;
  std::string page;
};
DrawnSizes zhao_drawn_sizes(std::uint64_t seed);

Files zhao_pictures(const ZhaoResults&);
std::string zhao_page(const ZhaoResults&, const DrawnSizes&, double seconds);

}  // namespace bernal::figures
