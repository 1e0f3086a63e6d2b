#include "cad/clearance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"

namespace bernal::cad {
namespace {

constexpr int cubes_along_longest_edge = 32;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double widening = 1e-6;  ///< of a cube's edge
constexpr double slack = 0.02;     ///< of a cube's edge, by which distances may be too large

/// Of a point outside the bounds.
constexpr ClearanceBounds beyond = {-infinity, -std::numeric_limits<double>::denorm_min()};

}  // namespace

ClearanceField::ClearanceField(const TriangleTree& tree, const Bounds<3>& bounds)
    : tree_(tree), lower_(bounds.lower), upper_(bounds.upper) {
  edge_ = bounds.size().maxCoeff() / cubes_along_longest_edge;
  per_edge_ = 1 / edge_;
  for (int k = 0; k < 3; ++k)
    count_[k] =
        std::clamp(static_cast<int>(std::ceil(bounds.size()[k] * per_edge_)), 1, cubes_along_longest_edge);
  clearance_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);

  // Along a row each cube bounds the search of the next and mostly knows its side. A row is one task, and so
  // the result does not depend on the number of threads.
  parallel_for(static_cast<std::size_t>(count_[1]) * count_[2], [&](std::size_t k) {
    const int row = static_cast<int>(k), y = row % count_[1], z = row / count_[1];
    double last = infinity;
    bool inside = false;
    for (int x = 0; x < count_[0]; ++x) {
      const Vector<3> center = center_of(x, y, z);
      const double most = (std::abs(last) + edge_) * (1 + widening);  // also where `last` is too large
      if (x == 0 || std::abs(last) <= edge_ * (1 + slack + widening))
        inside = tree.crossing(center, 0, -infinity) == Crossing::odd;
      const double distance = tree.rough_distance(center, most, slack * edge_);
      last = inside ? distance : -distance;
      clearance_[static_cast<std::size_t>(row) * count_[0] + x] = last;
    }
  });
}

ClearanceBounds ClearanceField::at(const Vector<3>& p) const {
  int cell[3];
  for (int k = 0; k < 3; ++k) {
    if (!(p[k] >= lower_[k] && p[k] <= upper_[k])) return beyond;
    cell[k] = std::min(static_cast<int>((p[k] - lower_[k]) * per_edge_), count_[k] - 1);
  }
  const double away = (p - center_of(cell[0], cell[1], cell[2])).norm() + (slack + widening) * edge_;
  const std::size_t row = static_cast<std::size_t>(cell[2]) * count_[1] + cell[1];
  const double clearance = clearance_[row * count_[0] + cell[0]];
  return {clearance - away, clearance + away};
}

Side ClearanceField::side(const Vector<3>& p) const {
  const ClearanceBounds here = at(p);
  if (here.inside()) return Side::inside;
  if (here.outside()) return Side::outside;
  for (int step = 1;; ++step) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        Vector<3> end = p;
        end[axis] += sign * step * edge_;
        const ClearanceBounds there = at(end);
        if (!there.inside() && !there.outside()) continue;
        const Crossing crossing = tree_.crossing(p, axis, end[axis]);
        if (crossing == Crossing::starts_on_wall) return Side::wall;
        return there.inside() == (crossing == Crossing::even) ? Side::inside : Side::outside;
      }
    }
  }
}

}  // namespace bernal::cad
