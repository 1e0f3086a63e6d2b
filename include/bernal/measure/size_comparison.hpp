#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The radii that are there against as many of the sequence that was drawn, both in ascending order. A
/// packing that ended early holds the drawn sequence less its tail: then the two agree to the bit. What a
/// packer leaves out because it is hard to place shows here, however little it is.
struct DrawnComparison {
  std::uint64_t missing = 0;  ///< radii of the sequence that are not there
  /// What every radius is times the drawn one, to rounding, where that is one number near 1: polishing in a
  /// container makes all spheres grow alike, and then none is missing. Otherwise 1.
  double scale = 1;
  double largest_deviation = 0;  ///< of the k-th smallest radius, over all k, relative to the drawn one
  /// Draws that were passed over because no radius is so large. A container refuses draws from an unbounded
  /// tail that it has hardly any room for; elsewhere none are passed over.
  std::uint64_t above_largest = 0;
};

/// The radii that are there against the distribution that was asked for, by number; where all are those drawn
/// times one factor, `drawn->scale`, without it.
struct SizeComparison {
  /// Kolmogorov & Smirnov: the largest distance of the two cumulative distributions.
  double ks_statistic = 0;
  /// How often independent draws would give a larger one; absent where sizes are asked for that have a share
  /// of their own (constant, classes), for which it would not be true. Near 1 where the radii are quantiles
  /// rather than draws.
  std::optional<double> ks_p_value;

  /// Where the asked distribution has such sizes only, these and Pearson's test of their counts.
  struct Class {
    double radius;
    double asked_share;
    std::uint64_t count;
  };
  std::vector<Class> classes;
  double chi_squared = 0;
  /// Absent for one class only and where fewer than 5 spheres of some class were to be expected.
  std::optional<double> chi_squared_p_value;

  /// What came of the shares that were asked for: of each of these sizes, or of tenths of the volume.
  struct Share {
    double above, up_to;  ///< radii; equal of one size, infinite where the largest have no end
    double asked_number, asked_volume;
    std::uint64_t count;
    double number, volume;  ///< shares of the spheres that are there
  };
  std::vector<Share> shares;  ///< ascending; empty for one size only

  double mean_radius = 0;
  double asked_mean_radius = 0;
  double volume_ratio = 1;        ///< <r^D> realised over asked
  double volume_ratio_error = 0;  ///< its standard error for independent draws

  struct Quantile {
    double share;     ///< of the number, below
    double realised;  ///< radius
    double asked;     ///< infinite at share 1 for an unbounded tail
  };
  std::vector<Quantile> quantiles;

  std::optional<DrawnComparison> drawn;  ///< where it is known how the radii were drawn
};

/// Cost: O(N log N) and two calls of asked.cumulative a sphere; about 0.3 µs each. Precondition: some radii.
/// Source of the p-value: the asymptotic distribution of Kolmogorov (1933) at (√N + 0.12 + 0.11/√N) times the
/// statistic, Stephens, J. R. Stat. Soc. B 32 (1970) 115, good to a few per cent from N = 5.
SizeComparison compare_sizes(std::span<const double> radii, const SizeDistribution& asked, int dimension);

/// Draws the radii again. `cut_tail`: the container may have refused draws from an unbounded tail. Nothing
/// where more than half of all draws are above the largest radius: the packing is not of that sequence. Cost:
/// O(N log N) and N draws. Precondition: some radii.
std::optional<DrawnComparison> compare_with_drawn(std::span<const double> radii, RadiusSequence sequence,
                                                  bool cut_tail);

}  // namespace bernal
