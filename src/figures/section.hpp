#pragma once
#include <string>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::figures {

/// Where a plane cuts a sphere: radius √(r² - h²) at the distance h of the plane from its centre.
struct CutCircle {
  Vector<2> center;  ///< along the two other axes, in their order, from the corner of the box
  double radius;
  std::size_t sphere;
};

/// The circles in which the plane x[axis] = height cuts spheres and their periodic images, as far as they
/// reach into the box. Precondition: three dimensions, centres in one period. Cost: O(N).
std::vector<CutCircle> cut_circles(const Spheres<dynamic>& spheres, const Box& box, int axis, double height);

/// A drawing of the middle plane across the last axis, `width` wide, as a whole SVG file; discs have the
/// colours of the sizes of their spheres, see io/legend.hpp.
std::string section_svg(const Spheres<dynamic>& spheres, const Box& box, double width);

}  // namespace bernal::figures
