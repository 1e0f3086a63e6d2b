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
constexpr double slack = 0.02;     ///< of a cube's edge; distances may be too large by this

/// For a point outside the bounds.
constexpr ClearanceBounds beyond = {-infinity, -std::numeric_limits<double>::denorm_min()};

}  // namespace

ClearanceField::ClearanceField(const TriangleTree& tree, const Bounds<3>& bounds,
                               const std::array<bool, 3>& open)
    : tree_(tree), lower_(bounds.lower), upper_(bounds.upper), open_(open) {
  edge_ = bounds.size().maxCoeff() / cubes_along_longest_edge;
  per_edge_ = 1 / edge_;
  for (int k = 0; k < 3; ++k)
    count_[k] =
        std::clamp(static_cast<int>(std::ceil(bounds.size()[k] * per_edge_)), 1, cubes_along_longest_edge);
  clearance_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);

  // Along a row each cube bounds the search of the next and usually knows its side. A row is one task, so the
  // result does not depend on the number of threads.
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

ClearanceField::Cell ClearanceField::cell_of(const Vector<3>& p) const {
  Cell cell;
  for (int k = 0; k < 3; ++k)
    cell[k] = std::min(static_cast<int>((p[k] - lower_[k]) * per_edge_), count_[k] - 1);
  return cell;
}

ClearanceBounds ClearanceField::at(const Vector<3>& p) const {
  for (int k = 0; k < 3; ++k)
    if (!(p[k] >= lower_[k] && p[k] <= upper_[k]))
      return open_[static_cast<std::size_t>(k)] ? ClearanceBounds{} : beyond;
  const Cell cell = cell_of(p);
  const double away = (p - center_of(cell[0], cell[1], cell[2])).norm() + (slack + widening) * edge_;
  const double clearance = clearance_[index(cell)];
  return {clearance - away, clearance + away};
}

Side ClearanceField::side(const Vector<3>& p) const {
  const ClearanceBounds here = at(p);
  if (here.inside()) return Side::inside;
  if (here.outside()) return Side::outside;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int sign : {-1, 1}) {
      Vector<3> end = p;
      end[axis] += sign * edge_;
      const ClearanceBounds there = at(end);
      if (!there.inside() && !there.outside()) continue;
      const Crossing crossing = tree_.crossing(p, axis, end[axis]);
      if (crossing == Crossing::starts_on_wall) return Side::wall;
      return there.inside() == (crossing == Crossing::even) ? Side::inside : Side::outside;
    }
  }
  return side_by_centre(p);
}

/// If the wall is so dense that no neighbouring cube is decided: along three axes, one after the other, to
/// the centre of the cube, whose side is known. No corner of that path may be on the wall.
Side ClearanceField::side_by_centre(const Vector<3>& p) const {
  const Cell cell = cell_of(p);
  const Vector<3> center = center_of(cell[0], cell[1], cell[2]);
  const double clearance = clearance_[index(cell)];
  const bool known = std::abs(clearance) > slack * edge_;  // or else the centre may be on the wall
  for (int turn = 0; turn < 6 && known; ++turn) {
    bool inside = clearance > 0;
    Vector<3> from = p;
    Crossing crossing = Crossing::even;
    for (int leg = 0; leg < 3 && crossing != Crossing::starts_on_wall; ++leg) {
      const int axis = (turn < 3 ? turn + leg : turn + 3 - leg) % 3;
      crossing = tree_.crossing(from, axis, center[axis]);
      if (crossing == Crossing::starts_on_wall && leg == 0) return Side::wall;
      inside ^= crossing == Crossing::odd;
      from[axis] = center[axis];
    }
    if (crossing != Crossing::starts_on_wall) return inside ? Side::inside : Side::outside;
  }
  const Crossing crossing = tree_.crossing(p, 0, -infinity);
  if (crossing == Crossing::starts_on_wall) return Side::wall;
  return crossing == Crossing::odd ? Side::inside : Side::outside;
}

}  // namespace bernal::cad
