#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Options of a search for the densest composition.
struct SearchOptions {
  /// Rods for the answer. Most of the search uses a quarter of them, but at least 1,000.
  int rods = 16000;
  /// Shares to start from, in any scale, instead of starts spread over all compositions: for when a similar
  /// problem is solved. Empty for none.
  std::vector<double> from;
  Monitor monitor;
};

/// The densest composition found, and how certain it is.
struct Optimum {
  std::vector<double> shares;  ///< of the volume, one for each population; they sum to 1
  Prediction prediction;       ///< of the mixture
  int starts = 0;              ///< starting points of the search
  int agreeing = 0;            ///< starts that ended within 1e-5 of the best packing fraction
  double spread = 0;           ///< difference between the best start and the worst
  int evaluations = 0;         ///< packing fractions computed
  bool cancelled = false;      ///< the monitor asked to stop; the best so far
};

/// The most populations whose composition is searched for.
inline constexpr int most_populations_to_mix = 6;

/// The mixture with these shares of the volume, none negative, some of them zero.
using MixtureOf = std::function<std::unique_ptr<SizeDistribution>(std::span<const double> shares)>;

/// The composition of 2 to 6 populations of spheres that packs densest by the rod model: the shares x_k of
/// the volume, x_k >= 0, Σ x_k = 1, that maximise phi.
///
/// The simplex of compositions is mapped to a cube, x_k = u_k (1 - x_1 - … - x_(k-1)), and searched without
/// derivatives (Nelder and Mead, restarted along either parametrisation until neither gains) from its centre
/// and from 4 more evenly spread points a population; the best three are refined with all rods. phi has kinks
/// where another rod begins to fit a gap, and local maxima between them, within 3e-4 of each other for two
/// and three sizes, 2e-3 for six; hence the many starts. If there are too few rods to represent large spheres
/// (Prediction::error above 1e-4), that excess is subtracted from phi, so that the search does not exploit
/// it. The maximum found is not proven to be global; `agreeing` and `spread` are the evidence for it.
///
/// Precondition: 2 to 6 radii, positive and finite, no farther apart than widest_ratio(rods), else
/// Error{bad_argument}. Equal radii are allowed (only the sum of their shares is then determined). Order and
/// scale of the radii do not matter. Deterministic; may be called from several threads at once. Cost: with
/// 4,000 rods 30 ms for two sizes, 0.1 s for three, 2 s for six, and three times that with 16,000; with 2,000
/// rods and `from` given, 20 ms for three.
///
/// Source: Farr, Powder Technology 245, 28 (2013), section V. Nelder & Mead, Computer J. 7, 308 (1965), in
/// S. G. Johnson's NLopt. The starts: M. Roberts, The unreasonable effectiveness of quasirandom sequences
/// (2018).
Optimum maximise_packing_fraction(std::span<const double> radii, const SearchOptions& options = {});

/// The same for populations of any kind. `mixture` is called once for each composition; its exceptions pass
/// through.
Optimum maximise_packing_fraction(const MixtureOf& mixture, int populations,
                                  const SearchOptions& options = {});

/// A member of a family of size distributions with one parameter.
using FamilyOf = std::function<std::unique_ptr<SizeDistribution>(double parameter)>;

/// The member of a family with a given packing fraction.
struct Match {
  bool found = false;
  double parameter = 0;
  Prediction prediction;             ///< of that member
  double least = 1, most = 0;        ///< packing fractions that the family reaches, if nothing was found
  double at_least = 0, at_most = 0;  ///< the parameters at these
};

/// The parameter nearest to `from`, between it and `to`, at which the rod model gives the packing fraction
/// `target`: the first bracket among 32 equal steps, closed by TOMS 748. If no step brackets the target, the
/// minimum and the maximum are refined by Brent's method and tried too. The result is accurate to 1e-7.
///
/// Precondition: target in (0, 1), from and to finite, rods >= 2, else Error{bad_argument}; `family` is
/// continuous. Its exceptions pass through. Deterministic. Cost: 10 to 100 predictions. Example:
///   match_packing_fraction([](double sigma) { return make_lognormal(1, sigma, Basis::volume, 0, inf); },
///                          1e-3, 3, 0.7)
/// has sigma 0.4619.
///
/// Source: Alefeld, Potra & Shi, ACM Trans. Math. Softw. 21, 327 (1995), in Boost.Math.
Match match_packing_fraction(const FamilyOf& family, double from, double to, double target, int rods = 16000);

/// The few sizes between a smallest and a largest one, these included, that pack densest.
struct DensestSizes {
  std::vector<double> radii;  ///< ascending
  Optimum optimum;            ///< its shares belong to `radii`
};

/// The `count` sizes between two radii, and their shares of the volume, that pack densest by the rod model.
/// The logarithms of the intermediate sizes are searched together with the composition, from even ones and 8
/// more starts. Precondition: 0 < min < max <= rods / 16 min, count from 2 to 6, else Error{bad_argument}.
/// Deterministic. Cost: 0.5 s for three sizes from 1 to 10, 2 s from 1 to 100; four times that for five.
DensestSizes densest_sizes(double min, double max, int count, const SearchOptions& options = {});

/// A density between two limits, by volume.
struct DensestDensity {
  std::vector<double> radii;  ///< limits of the bins, evenly spaced on a logarithmic axis; one more than bins
  Optimum optimum;            ///< its shares belong to the bins
  /// For 2, 4, 8, … bins up to the requested number, all with the same `rods`.
  struct Level {
    int bins;
    double phi;
  };
  std::vector<Level> levels;
  /// For comparison: the densest power law, with the share (r^q - min^q) / (max^q - min^q) below r, and its
  /// q.
  double power_law_phi = 0, power_law_exponent = 0;
};

/// The densest density by the rod model among those that are constant in each bin on a logarithmic axis:
/// make_sieve(radii, sums of the shares). The search moves shares between bins in ever smaller amounts; each
/// number of bins starts from the one before, from the best power law and from the densest few sizes. During
/// the search 128 classes represent the bins; the result is exact.
///
/// There is no densest density: with more bins the best one becomes denser and concentrates in narrow peaks,
/// whose limit is `densest_sizes`. `levels` shows the trend.
///
/// Precondition: 0 < min < max <= rods / 16 min, bins 2, 4, 8, 16, 32 or 64, else Error{bad_argument}.
/// Deterministic. Cost: 2 s for 16 bins from 1 to 10, 6 s from 1 to 100.
DensestDensity densest_density(double min, double max, int bins, const SearchOptions& options = {});

/// The largest ratio of radii that this number of rods can represent; a precondition of the functions above.
constexpr double widest_ratio(int rods) { return rods / 16.0; }

}  // namespace bernal
