#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The packing's radii against the drawn sequence of the same length, both ascending. A packing that ended
/// early holds the start of the sequence; then the two agree to the bit. Any radii that a packer left out
/// because they are hard to place show here.
struct DrawnComparison {
  std::uint64_t missing = 0;  ///< radii of the sequence that the packing lacks
  /// The ratio of every radius to the drawn one, if that is one number near 1 to rounding: polishing in a
  /// container grows all spheres alike, and no radius is missing. Otherwise 1.
  double scale = 1;
  double largest_deviation = 0;  ///< of the k-th smallest radius, over all k, relative to the drawn one
  /// Draws skipped because they exceed the largest radius. A container refuses draws from an unbounded tail
  /// that hardly fit in; otherwise 0.
  std::uint64_t above_largest = 0;
};

/// The packing's radii against the requested distribution, by number. If all radii are the drawn ones times
/// `drawn->scale`, that factor is removed first.
struct SizeComparison {
  /// Kolmogorov-Smirnov statistic: the largest distance of the two cumulative distributions.
  double ks_statistic = 0;
  /// Probability that independent draws give a larger statistic. Absent if the distribution has discrete
  /// sizes (constant, classes), for which the formula does not hold. Near 1 if the radii are quantiles rather
  /// than draws.
  std::optional<double> ks_p_value;

  /// Only for distributions of discrete sizes: the classes and Pearson's test of their counts.
  struct Class {
    double radius;
    double asked_share;
    std::uint64_t count;
  };
  std::vector<Class> classes;
  double chi_squared = 0;
  /// Absent for a single class and if fewer than 5 spheres were expected in some class.
  std::optional<double> chi_squared_p_value;

  /// Requested and realised shares: per class, or per tenth of the volume.
  struct Share {
    double above, up_to;  ///< radii; equal for a single size, infinite for an unbounded tail
    double asked_number, asked_volume;
    std::uint64_t count;
    double number, volume;  ///< shares of the packing's spheres
  };
  std::vector<Share> shares;  ///< ascending; empty for a single size

  double mean_radius = 0;
  double asked_mean_radius = 0;
  double volume_ratio = 1;        ///< <r^D> realised over asked
  double volume_ratio_error = 0;  ///< its standard error for independent draws

  struct Quantile {
    double share;     ///< of the spheres below
    double realised;  ///< radius
    double asked;     ///< infinite at share 1 for an unbounded tail
  };
  std::vector<Quantile> quantiles;
  /// The same by volume, r^D: half of D10, D50 and D90.
  std::vector<Quantile> volume_quantiles;

  std::optional<DrawnComparison> drawn;  ///< only if it is known how the radii were drawn
};

/// Cost: O(N log N) and two calls of asked.cumulative a sphere, about 0.3 µs each. Precondition: some radii.
/// Source of the p-value: the asymptotic distribution of Kolmogorov (1933) at (√N + 0.12 + 0.11/√N) times the
/// statistic, Stephens, J. R. Stat. Soc. B 32 (1970) 115, good to a few per cent from N = 5.
SizeComparison compare_sizes(std::span<const double> radii, const SizeDistribution& asked, int dimension);

/// Repeats the draws and compares. `cut_tail`: the container may have refused draws from an unbounded tail.
/// Absent if more than half of all draws exceed the largest radius: the packing then has another sequence.
/// Cost: O(N log N) and N draws. Precondition: some radii.
std::optional<DrawnComparison> compare_with_drawn(std::span<const double> radii, RadiusSequence sequence,
                                                  bool cut_tail);

}  // namespace bernal
