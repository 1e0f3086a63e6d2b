#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "support/plain_check.hpp"
#include "support/polygons.hpp"

// How near spheres are to each other and to the walls: all pairs and all images, textbook formulas. Shares
// nothing with packer or certificate.
namespace bernal::testing {

/// Of each axis, infinite where it does not repeat itself.
inline std::vector<double> periods_of(const Domain& domain) {
  std::vector<double> periods(static_cast<std::size_t>(dimension_of(domain)),
                              std::numeric_limits<double>::infinity());
  if (const auto* box = std::get_if<Box>(&domain))
    for (int k = 0; k < box->dimension(); ++k)
      if (box->repeats(k)) periods[static_cast<std::size_t>(k)] = box->size[k];
  if (const auto* cylinder = std::get_if<Cylinder>(&domain); cylinder && cylinder->periodic)
    periods[static_cast<std::size_t>(cylinder->coordinate_axis())] = cylinder->height;
  if (const auto* mesh = std::get_if<Mesh>(&domain))
    for (int k = 0; k < 3; ++k) {
      if (!mesh->periodic[static_cast<std::size_t>(k)]) continue;
      const auto [least, most] =
          std::ranges::minmax(mesh->vertices, {}, [&](const Vector<3>& v) { return v[k]; });
      periods[static_cast<std::size_t>(k)] = most[k] - least[k];
    }
  return periods;
}

/// The least d - ri - rj over all pairs and images, those of a sphere itself among them.
inline double least_gap(const Spheres<dynamic>& spheres, const Domain& domain) {
  const std::vector<double> periods = periods_of(domain);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double squared = 0;
      for (std::size_t k = 0; k < periods.size(); ++k) {
        double d = std::abs(spheres.x[k][i] - spheres.x[k][j]);
        if (std::isfinite(periods[k])) {
          d = std::fmod(d, periods[k]);
          d = std::min(d, periods[k] - d);
        }
        squared += d * d;
      }
      least = std::min(least, std::sqrt(squared) - spheres.r[i] - spheres.r[j]);
    }
    for (const double period : periods) least = std::min(least, period - 2 * spheres.r[i]);
  }
  return least;
}

/// The least distance of a surface from a wall, negative outside; infinite without walls.
inline double least_wall_gap(const Spheres<dynamic>& spheres, const Domain& domain) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; has_walls(domain) && i < spheres.size(); ++i) {
    const Vector<dynamic> c = spheres.center(i);
    const double r = spheres.r[i];
    const bool flat = std::holds_alternative<Polygon>(domain);
    least = std::min(least, flat ? static_cast<double>(test::precise_clearance_flat(domain, Vector<2>(c))) - r
                                 : plain::wall_gap(c, r, domain).gap);
  }
  return least;
}

}  // namespace bernal::testing
