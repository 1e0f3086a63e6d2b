#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/measure/lower_part.hpp"

namespace bernal {

/// The radial distribution function of the centres in a periodic box: the number of centres at distance r
/// from a centre over the number for uniformly random points,
///   g(r) = (mean number of centres in the shell from r - w/2 to r + w/2) / ((N - 1) / V · volume of the
///   shell).
/// It is 1 for an ideal gas. Lengths are in the scene's unit.
///
/// Between walls, only centres at least a mean diameter off every wall count, which leaves the layer at the
/// walls out; or where those are fewer than half of all, every centre. V is the volume where such centres may
/// be, and of every shell the share counts that lies there: so g of points at random is 1. Of a bed, V ends
/// at its level.
struct RadialDistribution {
  double mean_diameter = 0;
  double bin_width = 0;   ///< w
  std::vector<double> r;  ///< middle of the bin
  std::vector<double> g;
  /// Standard error of g from counting, that of one pair if none was found; between walls also from `share`.
  /// 0 in bins below the distance at which two of the smallest spheres touch, where no pair can be; but where
  /// spheres overlap that far, as elsewhere.
  std::vector<double> error;
  /// Between walls: of the shells about the centres, the mean share that lies in V, and its standard error.
  /// Empty in periodic boxes.
  std::vector<double> share, share_error;
  std::uint64_t references = 0;  ///< centres used as origin, evenly spread
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
  double reach =
      5;  ///< mean diameters; limited to half the shortest period, and between walls to `least_share`
  double work = 2e8;  ///< approximate number of distances computed; larger packings are sampled
  /// Between walls: approximate number of places of which it is asked whether they are inside; a fifth of
  /// that in a mesh.
  double places = 4e6;
  std::optional<LowerPart> below = {};  ///< between walls: the part that counts

  /// Bins of which a smaller share lies inside are left out.
  static constexpr double least_share = 0.05;
};

/// Absent for fewer than two spheres, and between walls in other than three dimensions. A distance below the
/// start of a bin by up to 1e-6 of its width counts in that bin, so that rounding does not split the contacts
/// of equal spheres. Cost: min(options.work, O(N reach^D)), at about 2 ns, between walls and options.places
/// questions to them; memory O(N). `made`: as `MeasureOptions::container`. Precondition: bin and reach
/// positive.
std::optional<RadialDistribution> radial_distribution(const Spheres<dynamic>&, const Domain&,
                                                      const RadialOptions& = {},
                                                      const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
