#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The radial distribution function of the centres in a periodic box: the number of centres at distance r
/// from a centre over the number for uniformly random points,
///   g(r) = (mean number of centres in the shell from r - w/2 to r + w/2) / ((N - 1) / V · volume of the
///   shell).
/// It is 1 for an ideal gas. Lengths are in the scene's unit.
struct RadialDistribution {
  double mean_diameter = 0;
  double bin_width = 0;   ///< w
  std::vector<double> r;  ///< middle of the bin
  std::vector<double> g;
  std::vector<double> error;     ///< standard error of g from counting; that of one pair if none was found
  std::uint64_t references = 0;  ///< centres used as origin, evenly spread over the box
  double radius_spread = 0;      ///< standard deviation of the radii over their mean

  /// Local maxima of g near 1, √3 and 2 mean diameters, if present; empty if the radii spread by more than
  /// `most_spread`. The peak at √3 comes from two triangles with a common side, that at 2 from three spheres
  /// in line: the split second peak of random close packing.
  struct Peak {
    double r, g, error;
  };
  std::vector<Peak> peaks;
  static constexpr double most_spread = 0.05;
};

struct RadialOptions {
  double bin = 0.02;  ///< of the mean diameter
  double reach = 5;   ///< mean diameters; limited to half the shortest edge
  double work = 2e8;  ///< approximate number of distances computed; larger packings are sampled
};

/// Absent if there are walls (with a free surface there is no density to compare with) and for fewer than two
/// spheres. A distance below the start of a bin by up to 1e-6 of its width counts in that bin, so that
/// rounding does not split the contacts of equal spheres. Cost: min(options.work, O(N reach^D)), at about 2
/// ns; memory O(N). Precondition: bin and reach positive.
std::optional<RadialDistribution> radial_distribution(const Spheres<dynamic>&, const Domain&,
                                                      const RadialOptions& = {});

}  // namespace bernal
