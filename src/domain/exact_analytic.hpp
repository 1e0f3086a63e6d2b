#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "domain/motion.hpp"

namespace bernal {

/// The walls of an analytic shape, by the doubles that it is given by; none of an axis that repeats itself.
std::vector<AnalyticWall> walls_of(const Box&);
std::vector<AnalyticWall> walls_of(const Cylinder&);
std::vector<AnalyticWall> walls_of(const Sphere&);

/// Whether the closed ball of radius r >= 0 about c lies between the walls, decided on the doubles as they
/// are: no rounding, no square root (domain/exact_way.hpp). Cost: some microseconds.
bool contains_exactly(const std::vector<AnalyticWall>& walls, const Vector<3>& c, double r);
template <class Shape>
bool contains_exactly(const Shape& shape, const Vector<3>& c, double r) {
  return contains_exactly(walls_of(shape), c, r);
}

/// The same of a polygon: the centre lies inside and no edge, ends included, is nearer to it than r. Cost:
/// O(edges), beside that of those that are about as near.
bool contains_exactly(const Polygon&, const Vector<3>& c, double r);

}  // namespace bernal
