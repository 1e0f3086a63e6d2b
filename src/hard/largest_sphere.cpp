#include "hard/convex_walls.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "bernal/core/random.hpp"
#include "work/linear_programme.hpp"

namespace bernal {

LargestSphere largest_sphere_between(std::span<const Wall<3>> planes, const Bounds<3>& bounds) {
  const Vector<3> middle = bounds.center();
  const double unit = bounds.diagonal();
  std::vector<Constraint<4>> spaces;
  for (const Wall<3>& plane : planes) {
    Vector<4> a;
    a << plane.along, 1;
    spaces.push_back({a, plane.clearance(middle) / unit});
  }
  Random random(0, stream(Stream::room));
  for (std::size_t i = spaces.size(); i > 1; --i)
    std::swap(spaces[i - 1], spaces[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  const Vector<4> best =
      optimum<4>(Vector<4>::Unit(3), spaces, {-Vector<4>::Constant(2), Vector<4>::Constant(2)});
  LargestSphere largest{middle + unit * best.head<3>(), std::numeric_limits<double>::infinity()};
  for (const Wall<3>& plane : planes)
    largest.radius = std::min(largest.radius, plane.clearance(largest.center));
  return largest;
}

}  // namespace bernal
