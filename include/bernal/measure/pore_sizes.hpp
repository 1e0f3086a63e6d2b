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

/// How large the pores are: of all points that no sphere covers, the distance d to the nearest solid, sphere
/// or wall. P(d) is the density of its distribution; at 0 it is the surface of the solids over the volume of
/// the pores. Lengths are in the scene's unit.
struct PoreSizes {
  std::uint64_t points = 0;  ///< random ones in the domain that were looked from
  std::uint64_t in_pores = 0;
  double porosity = 0, porosity_error = 0;  ///< the share of these; the errors are standard errors
  double mean_diameter = 0;                 ///< of the spheres
  // Over the points in pores; zero without any.
  double mean = 0, mean_error = 0;                    ///< of d
  double second_moment = 0, second_moment_error = 0;  ///< mean of d²
  double largest = 0;                                 ///< that was seen

  /// Distances below which this share of the pores is.
  struct Quantile {
    double share, distance;
  };
  std::vector<Quantile> quantiles;

  double bin_width = 0;
  std::vector<double> d;        ///< middle of the bin
  std::vector<double> density;  ///< P; the sum over the bins of P · bin_width is 1
  std::vector<double> error;
};

struct PoreOptions {
  std::uint32_t points = 100'000;
  double bin = 0.01;  ///< mean diameters; wider where the largest distance is more than a hundred bins
  /// Between walls: from points below a level alone; those in containers that fill little of their bounds are
  /// fewer then.
  std::optional<LowerPart> below = {};
};

/// Absent without spheres or points, and between walls in other dimensions than two and three. The same
/// points for the same domain, and the same bits for any number of threads. Cost: about 1 µs a point, and 0.5
/// µs a sphere for a tree. `made`: see `local_container`. Precondition: options positive. Source: Torquato,
/// Random Heterogeneous Materials (2002), section 2.6, where d is called δ.
std::optional<PoreSizes> pore_sizes(const Spheres<dynamic>&, const Domain&, const PoreOptions& = {},
                                    const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
