#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/scene/scene.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// What a scene's sizes come to, by number and by volume. Lengths in the scene's unit; a volume is r^D, in
/// two dimensions an area.
struct SizeSummary {
  /// One of few sizes, a radius or a diameter as the scene says, ascending.
  struct Share {
    double size;
    std::string name;  ///< that the scene gives a class; mostly empty
    double number, volume;
    std::optional<double> mass;  ///< where the scene says densities
  };
  std::vector<Share> shares;  ///< none for a single size, and for many

  /// A diameter with this share below.
  struct Percentile {
    double share, by_number, by_volume;
  };
  std::vector<Percentile> percentiles;  ///< D10, D50, D90; none for a single size

  /// How near the law comes to a percentile that the scene gives, by its basis: both diameters.
  struct Fit {
    std::string_view name;
    double share, given, fitted;
  };
  std::vector<Fit> fit;
};

/// Precondition: radii of the scene. Cost: some 300 moments.
SizeSummary summary_of(const Scene& scene, const SizeDistribution& radii);

/// The lines of `explain` on it; empty for a single size.
std::string summary_in_words(const SizeSummary& summary, const Scene& scene);

/// "d90 3.61 (+3.1 %)"
std::string fit_in_words(const SizeSummary::Fit&);
/// "by volume", as the fit counts.
std::string basis_of_fit(const Scene& scene);

}  // namespace bernal
