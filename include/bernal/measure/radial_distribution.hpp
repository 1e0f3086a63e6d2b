#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The radial distribution function of the centres in a periodic box: how many centres lie at the distance r
/// from a centre, compared with what chance would put there,
///   g(r) = (mean number of centres in the shell from r - w/2 to r + w/2) / ((N - 1) / V · volume of the
///   shell),
/// 1 for an ideal gas. Lengths are in the scene's unit.
struct RadialDistribution {
  double mean_diameter = 0;
  double bin_width = 0;   ///< w
  std::vector<double> r;  ///< middle of the bin
  std::vector<double> g;
  std::vector<double> error;     ///< standard error of g from counting; that of one pair where none was found
  std::uint64_t references = 0;  ///< centres that were looked from, evenly spread over the box
  double radius_spread = 0;      ///< standard deviation of the radii over their mean

  /// Local maxima of g near 1, √3 and 2 mean diameters, as far as there are any; none where the radii are
  /// spread by more than `most_spread`. The peak at √3 is that of two triangles with a common side, the one
  /// at 2 that of three spheres in line: the split second peak of random close packing.
  struct Peak {
    double r, g, error;
  };
  std::vector<Peak> peaks;
  static constexpr double most_spread = 0.05;
};

struct RadialOptions {
  double bin = 0.02;  ///< of the mean diameter
  double reach = 5;   ///< mean diameters; at most half the shortest edge is looked at
  double work = 2e8;  ///< about how many distances are computed; larger packings are sampled
};

/// Absent where there are walls, which with the free surface leave no density to compare with, and for fewer
/// than two spheres. A distance that rounding brought below a bin by 1e-6 of its width counts in that
/// bin, so that contacts of equal spheres come together. Cost: min(options.work, O(N reach^D)), at about 2
/// ns; memory O(N). Precondition: bin and reach positive.
std::optional<RadialDistribution> radial_distribution(const Spheres<dynamic>&, const Domain&,
                                                      const RadialOptions& = {});

}  // namespace bernal
