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

/// Pore sizes: the distance d from a point that no sphere covers to the nearest solid, sphere or wall. P(d)
/// is its probability density over all such points; P(0) is the surface of the solids over the volume of the
/// pores. Lengths are in the scene's unit.
struct PoreSizes {
  std::uint64_t points = 0;  ///< random points in the domain
  std::uint64_t in_pores = 0;
  double porosity = 0, porosity_error = 0;  ///< share of the points in pores; errors are standard errors
  double mean_diameter = 0;                 ///< of the spheres
  // Over the points in pores; zero if there are none.
  double mean = 0, mean_error = 0;                    ///< of d
  double second_moment = 0, second_moment_error = 0;  ///< mean of d²
  double largest = 0;                                 ///< largest d found

  /// The distance that d is below for this share of the pores.
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
  double bin = 0.01;  ///< in mean diameters; wider if the largest distance exceeds a hundred bins
  /// Between walls, only points below this level count; containers that fill little of their bounds then get
  /// fewer points.
  std::optional<LowerPart> below = {};
};

/// Absent without spheres or points, and between walls in other than two or three dimensions. The same domain
/// gets the same points; the result is the same for any number of threads. Cost: about 1 µs a point, and 0.5
/// µs a sphere for a tree. `made`: as `MeasureOptions::container`. Precondition: options positive. Source:
/// Torquato, Random Heterogeneous Materials (2002), section 2.6, where d is called δ.
std::optional<PoreSizes> pore_sizes(const Spheres<dynamic>&, const Domain&, const PoreOptions& = {},
                                    const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
