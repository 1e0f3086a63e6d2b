#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Whether spheres of like size lie together: the correlation of the radii of two spheres whose centres are a
/// distance d apart (a mark correlation function),
///   C(d) = mean of (r_i - m)(r_j - m) over the pairs from d - w/2 to d + w/2, divided by the variance of r,
/// with m the mean radius. 0 for independent sizes (exactly -1 / (N - 1), as all are drawn from the same
/// set); positive far out if sizes segregate. Lengths are in the scene's unit.
///
/// The distance of touching spheres depends on their sizes, so C oscillates without segregation: two small
/// spheres are nearer than a mean diameter, C > 0; a small and a large one are about one diameter apart, C <
/// 0; two large ones are farther apart, C > 0; and again around two diameters. Segregation shows in the mean
/// over such distances, in C from 2.5 mean diameters on, and in the correlation of neighbours.
struct SizeCorrelation {
  double mean_diameter = 0;
  double bin_width = 0;   ///< w
  std::vector<double> d;  ///< middle of the bin
  std::vector<double> c;  ///< 0 if no pair was found
  /// Standard error for sizes assigned at random, 1 / √(number of pairs): products of independent sizes are
  /// uncorrelated even if pairs share a sphere. That of one pair if there is none.
  std::vector<double> error;
  std::uint64_t references = 0;  ///< centres used as origin, evenly spread over the domain

  struct Mean {
    double c, error;
  };
  /// Over all pairs in bins between two distances, in mean diameters; absent without such a bin.
  std::optional<Mean> mean_between(double from, double to) const;

  /// Pearson's correlation of the radii at both ends of the bonds between neighbours, which are nearer than
  /// (1 + BondOrder::widest_gap)(ri + rj). Mean and variance are those over the ends of bonds, so that large
  /// spheres count more often. As the neighbours depend on the sizes, it is slightly below 0 without
  /// segregation, -0.06 in random close packings of lognormal spheres with sigma 0.3; compare with another
  /// packing of the same sizes. For more than BondOrder::most_spheres only those in the middle are evaluated.
  /// Absent if all spheres with neighbours have one size.
  struct Neighbours {
    double correlation, error;  ///< 1 / √pairs
    std::uint64_t pairs;
  };
  std::optional<Neighbours> neighbours;
};

struct SizeCorrelationOptions {
  double bin = 0.1;   ///< of the mean diameter
  double reach = 5;   ///< mean diameters; limited to half the shortest period
  double work = 2e8;  ///< approximate number of distances computed; larger packings are sampled
};

/// Distances, in mean diameters, for the means in reports.
inline constexpr std::pair<double, double> size_correlation_ranges[] = {{1, 2}, {2, 3}, {2.5, 5}};

/// Absent if all spheres have the same size, to rounding, for fewer than two, and in a period shorter than
/// two bins. Walls are ignored: only existing pairs are compared. Any dimension. The result is the same for
/// any number of threads. Cost: min(options.work, O(N reach^D)), at about 3 ns; memory O(N). Precondition:
/// bin and reach positive, spheres of the domain's dimension. Source: Stoyan & Stoyan, Fractals, Random
/// Shapes and Point Fields (1994), mark correlation functions.
std::optional<SizeCorrelation> size_correlation(const Spheres<dynamic>&, const Domain&,
                                                const SizeCorrelationOptions& = {});

}  // namespace bernal
