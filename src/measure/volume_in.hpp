#pragma once
#include <cstddef>

#include "bernal/core/spheres.hpp"
#include "bernal/measure/lower_part.hpp"
#include "domain/ball_below.hpp"
#include "domain/volume_below.hpp"

// Volumes, in two dimensions areas, of what lies in a part of a domain; exact to rounding.
namespace bernal {

/// Of the domain. Precondition: `below` is that of the part's direction.
inline double volume_in(const LowerPart& part, const VolumeBelow& below) {
  return below(part.height) - below(part.from);
}

/// Of a sphere.
inline double ball_in(const LowerPart& part, int dimension, const Vector<3>& center, double r) {
  const double z = part.height_of(center);
  return ball_below(dimension, r, part.height - z) - ball_below(dimension, r, part.from - z);
}

/// Of all spheres.
inline double filled_in(const LowerPart& part, int dimension, const Spheres<3>& spheres) {
  double sum = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    sum += ball_in(part, dimension, spheres.center(i), spheres.r[i]);
  return sum;
}

/// Whether planes across this direction can end a part: the domain has walls and does not repeat itself along
/// it.
inline bool has_ends_along(const Domain& domain, const Vector<3>& direction) {
  const int dimension = dimension_of(domain);
  return has_walls(domain) && (dimension == 2 || dimension == 3) &&
         direction.cwiseProduct(boundary_in_space(domain).edges).isZero(0);
}

}  // namespace bernal
