#include "measure/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_planes = 12;
constexpr int most_sweeps = 200;
/// In a chain of places: more than between neighbours in ordinary cells.
constexpr int most_fine_pieces = 160;
/// The nearest facet may be farther than the clearance by this, so that hardly any others are found: from the
/// middle of a round part thousands are nearly as near.
constexpr double within = 1 + 1e-9, roundoffs = 16;

/// Half-spaces (x - point)·normal >= 0 and the point in all of them that is nearest to `start`: one
/// multiplier a plane, by Hildreth's coordinate ascent. Source: C. Hildreth, Nav. Res. Logist. Q. 4 (1957)
/// 79.
class HalfSpaces {
 public:
  explicit HalfSpaces(const Vector<3>& start) : start_(start), nearest_(start) {}

  bool full() const { return count_ == most_planes; }
  const Vector<3>& nearest() const { return nearest_; }

  /// False if no common point is within `limit`.
  bool add(const Vector<3>& point, const Vector<3>& normal, double limit, double precision) {
    planes_[count_++] = {normal, normal.dot(point), 0};
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double moved = 0, least = 0;  // least: the dual, at most half the squared distance
      for (std::size_t k = 0; k < count_; ++k) {
        Plane& plane = planes_[k];
        const double multiplier = std::max(0.0, plane.multiplier + plane.offset - plane.normal.dot(nearest_));
        const double step = multiplier - plane.multiplier;
        nearest_ += step * plane.normal;
        plane.multiplier = multiplier;
        moved = std::max(moved, std::abs(step));
        least += multiplier * (plane.offset - plane.normal.dot(start_));
      }
      if (least - 0.5 * (nearest_ - start_).squaredNorm() > 0.5 * limit * limit) return false;
      if (moved <= precision) break;
    }
    return true;
  }

 private:
  struct Plane {
    Vector<3> normal;
    double offset, multiplier;
  };
  std::array<Plane, most_planes> planes_;
  std::size_t count_ = 0;
  Vector<3> start_, nearest_;
};

}  // namespace

std::optional<Place> FreeSpace::nearest(const Vector<3>& p, double limit) const {
  throw_if_interrupted();
  HalfSpaces beyond(p);
  std::vector<NearFacet> facets;
  for (;;) {
    const Vector<3> q = beyond.nearest();
    if (!((q - p).norm() <= limit)) return {};
    const double clearance = container_.clearance_within(q, r_ + limit);
    if (is_place(clearance)) return Place{q, clearance};
    if (!(clearance > 0) || beyond.full()) return {};
    facets.clear();
    container_.facets_near(q, within * clearance + roundoffs * container_.resolution(), facets);
    if (facets.empty()) return {};
    const Vector<3> wall = closest_point(facets.front().facet, q);
    const double d = (q - wall).norm();
    if (!(d > 0)) return {};
    const Vector<3> inward = (q - wall) / d;
    if (!beyond.add(wall + r_ * inward, inward, limit, 0.1 * slack * r_)) return {};
  }
}

bool FreeSpace::joined(const Place& a, const Place& b, double step, double coarse) const {
  int pieces = most_fine_pieces;
  return joined(a, b, step, coarse, pieces);
}

bool FreeSpace::joined(const Place& a, const Place& b, double step, double coarse, int& pieces) const {
  const double d = (b.point - a.point).norm();
  if (a.clearance - r_ + b.clearance - r_ >= d || d <= (pieces > 0 ? step : coarse)) return true;
  --pieces;
  const std::optional<Place> middle = nearest(0.5 * (a.point + b.point), 0.25 * d);
  return middle && joined(a, *middle, step, coarse, pieces) && joined(*middle, b, step, coarse, pieces);
}

}  // namespace bernal
