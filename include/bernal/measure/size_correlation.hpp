#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Whether spheres of like sizes lie together: the correlation of the radii of two spheres whose centres are
/// a distance d apart,
///   C(d) = mean of (r_i - m)(r_j - m) over the pairs from d - w/2 to d + w/2, divided by the variance of r,
/// m the mean radius: a mark correlation function. 0 where sizes know nothing of each other, -1 / (N - 1) to
/// be exact, as all are drawn from the same ones; positive far out where sizes separate. Lengths are in the
/// scene's unit.
///
/// Spheres that touch are as far apart as their sizes say. So C swings where nothing separates: two small
/// ones are nearer than a mean diameter, C > 0; a small and a large one about one diameter apart, C < 0; two
/// large ones farther, C > 0; and once more around two diameters. What sizes know of each other beyond that
/// is told by the mean over such distances, by C from 2.5 mean diameters on, and by the correlation of
/// neighbours.
struct SizeCorrelation {
  double mean_diameter = 0;
  double bin_width = 0;   ///< w
  std::vector<double> d;  ///< middle of the bin
  std::vector<double> c;  ///< 0 where no pair was found
  /// Standard error of sizes that are put on the places by chance, 1 / √(number of pairs): products of
  /// independent sizes are uncorrelated even where pairs share a sphere. That of one pair where there is
  /// none.
  std::vector<double> error;
  std::uint64_t references = 0;  ///< centres that were looked from, evenly spread over the domain

  struct Mean {
    double c, error;
  };
  /// Over all pairs whose bins lie between two distances, in mean diameters; absent where there is no bin.
  std::optional<Mean> mean_between(double from, double to) const;

  /// Pearson's correlation of the sizes at both ends of the bonds between neighbours, which are nearer than
  /// (1 + BondOrder::widest_gap)(ri + rj); the mean and variance are those at the ends of bonds, where large
  /// spheres come up more often. As which spheres are neighbours depends on their sizes, it is somewhat below
  /// 0 where nothing separates, -0.06 in random close packings of lognormal spheres with sigma 0.3: to be
  /// held against another packing of the same sizes. Of more than BondOrder::most_spheres those in the middle
  /// are looked at. Absent where all that have neighbours are of one size.
  struct Neighbours {
    double correlation, error;  ///< 1 / √pairs
    std::uint64_t pairs;
  };
  std::optional<Neighbours> neighbours;
};

struct SizeCorrelationOptions {
  double bin = 0.1;   ///< of the mean diameter
  double reach = 5;   ///< mean diameters; at most half the shortest period is looked at
  double work = 2e8;  ///< about how many distances are computed; larger packings are sampled
};

/// Distances, in mean diameters, over which reports state the mean.
inline constexpr std::pair<double, double> size_correlation_ranges[] = {{1, 2}, {2, 3}, {2.5, 5}};

/// Absent where all spheres have the same size, to rounding, for fewer than two, and in a period shorter than
/// two bins. In periodic boxes and in containers, whose walls are not seen: the pairs that there are are
/// compared. Any dimension. The same bits for any number of threads. Cost: min(options.work, O(N reach^D)),
/// at about 3 ns; memory O(N). Precondition: bin and reach positive, spheres of the domain's dimension.
/// Source: Stoyan & Stoyan, Fractals, Random Shapes and Point Fields (1994), mark correlation functions.
std::optional<SizeCorrelation> size_correlation(const Spheres<dynamic>&, const Domain&,
                                                const SizeCorrelationOptions& = {});

}  // namespace bernal
