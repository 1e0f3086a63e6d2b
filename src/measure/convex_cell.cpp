#include "measure/convex_cell.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bernal {

void ConvexCell::reset(const Vector<3>& lower, const Vector<3>& upper, const std::array<Label, 3>& sides) {
  corners_.clear();
  edges_.clear();
  labels_.clear();
  for (int k = 0; k < 8; ++k)
    corners_.push_back({Vector<3>((k & 1) ? upper[0] : lower[0], (k & 2) ? upper[1] : lower[1],
                                  (k & 4) ? upper[2] : lower[2])});
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
    for (const bool is_upper : {false, true}) {
      const std::uint32_t base = is_upper ? 1u << axis : 0;
      std::array<std::uint32_t, 4> loop = {base, base | u, base | u | v, base | v};  // normal along +axis
      if (!is_upper) std::swap(loop[1], loop[3]);
      for (std::size_t k = 0; k < 4; ++k)
        edges_.push_back({loop[k], loop[(k + 1) % 4], static_cast<std::uint32_t>(labels_.size())});
      labels_.push_back(sides[static_cast<std::size_t>(axis)]);
    }
  }
}

/// The corner where the plane cuts the edge between two corners: one for both directions.
std::uint32_t ConvexCell::crossing(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  for (const Crossing& c : crossings_)
    if (c.low == low && c.high == high) return c.corner;
  const double t = height_[low] / (height_[low] - height_[high]);
  const Vector<3> point = corners_[low].point + t * (corners_[high].point - corners_[low].point);
  crossings_.push_back({low, high, static_cast<std::uint32_t>(corners_.size())});
  corners_.push_back({point});
  return crossings_.back().corner;
}

bool ConvexCell::cut(const Vector<3>& normal, double offset, Label label, double slack) {
  if (edges_.empty()) return false;
  height_.clear();
  double highest = 0;
  for (const Corner& corner : corners_) {
    height_.push_back(corner.point.dot(normal) - offset);
    highest = std::max(highest, height_.back());
  }
  if (!(highest > slack)) return false;

  crossings_.clear();
  exits_.clear();
  entries_.clear();
  kept_.clear();
  for (const Edge& edge : edges_) {
    const bool from = height_[edge.from] <= 0, to = height_[edge.to] <= 0;
    if (from && to) {
      kept_.push_back(edge);
    } else if (from) {
      const std::uint32_t corner = crossing(edge.from, edge.to);
      kept_.push_back({edge.from, corner, edge.face});
      exits_.push_back({edge.face, corner});
    } else if (to) {
      const std::uint32_t corner = crossing(edge.from, edge.to);
      kept_.push_back({corner, edge.to, edge.face});
      entries_.push_back({edge.face, corner});
    }
  }
  // A face that is left is entered again as often as it is left; what joins the two is an edge of the cut.
  const auto cap = static_cast<std::uint32_t>(labels_.size());
  for (const Open& exit : exits_) {
    const auto entry = std::ranges::find(entries_, exit.face, &Open::face);
    if (entry->corner != exit.corner) {
      kept_.push_back({exit.corner, entry->corner, exit.face});
      kept_.push_back({entry->corner, exit.corner, cap});
    }
    *entry = entries_.back();
    entries_.pop_back();
  }
  edges_.swap(kept_);
  labels_.push_back(label);
  drop_unused_corners();
  return true;
}

void ConvexCell::drop_unused_corners() {
  constexpr std::uint32_t unused = ~std::uint32_t{0};
  std::vector<std::uint32_t>& number = numbers_;
  number.assign(corners_.size(), unused);
  for (const Edge& edge : edges_) number[edge.from] = 0;
  std::uint32_t count = 0;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    if (number[k] == unused) continue;
    corners_[count] = corners_[k];
    number[k] = count++;
  }
  corners_.resize(count);
  for (Edge& edge : edges_) edge = {number[edge.from], number[edge.to], edge.face};
}

double ConvexCell::volume() const {
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t>& apex = numbers_;
  apex.assign(labels_.size(), none);
  double sum = 0;
  for (const Edge& edge : edges_) {
    if (apex[edge.face] == none) apex[edge.face] = edge.from;
    const Vector<3>& p = corners_[apex[edge.face]].point;
    sum += p.dot(corners_[edge.from].point.cross(corners_[edge.to].point));
  }
  return sum / 6;
}

double ConvexCell::squared_reach() const {
  double farthest = 0;
  for (const Corner& corner : corners_) farthest = std::max(farthest, corner.point.squaredNorm());
  return farthest;
}

/// Twice the area of every face, along its normal outwards.
void ConvexCell::find_areas() const {
  areas_.assign(labels_.size(), Vector<3>::Zero());
  for (const Edge& edge : edges_)
    areas_[edge.face] += corners_[edge.from].point.cross(corners_[edge.to].point);
}

std::uint32_t ConvexCell::faces(double least) const {
  find_areas();
  double surface = 0;
  for (const Vector<3>& area : areas_) surface += area.norm();
  std::uint32_t count = 0;
  for (std::size_t face = 0; face < labels_.size(); ++face)
    count += labels_[face] >= 0 && areas_[face].norm() > least * surface;
  return count;
}

std::vector<ConvexCell::Plane> ConvexCell::planes() const {
  find_areas();
  std::vector<Plane> found;
  for (Vector<3>& area : areas_) {
    area.stableNormalize();
    found.push_back({area, -std::numeric_limits<double>::infinity()});
  }
  for (const Edge& edge : edges_)
    found[edge.face].offset =
        std::max(found[edge.face].offset, found[edge.face].normal.dot(corners_[edge.from].point));
  std::erase_if(found, [](const Plane& plane) { return plane.normal.isZero(0); });
  return found;
}

}  // namespace bernal
