#pragma once
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Where the corners of a surface stand that takes the place of a round one.
enum class RoundAs {
  inscribed,      ///< on it
  of_same_area,   ///< so that every section across the axis has the area of the round one
  circumscribed,  ///< so that the solid lies inside of the surface, touching its sides
  within,         ///< so that the surface lies inside of the solid, to rounding
};

/// A solid of revolution as a closed mesh with so many sides around, oriented outwards; the one way in which
/// pictures, measures and formats that know no such solid see it. It departs from the round one by at most
/// R (1 / cos(pi / sides) - 1), R the largest radius. `turn`: of the first corner about the axis, in steps
/// from one to the next. Cost: two triangles a side and edge.
Mesh surface_of(const Revolved&, int sides, RoundAs as = RoundAs::inscribed, double turn = 0);

/// How many sides keep it within that deflection, at least 12.
double sides_for(const Revolved&, double deflection);

}  // namespace bernal
