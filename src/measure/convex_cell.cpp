#include "measure/convex_cell.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace bernal {

void ConvexCell::reset(const Vector<3>& lower, const Vector<3>& upper, const std::array<Label, 6>& sides) {
  resize(8);
  labels_.assign(sides.begin(), sides.end());
  for (unsigned k = 0; k < 8; ++k) {
    const auto above = [&](unsigned axis) { return k >> axis & 1; };
    // Anticlockwise these are the edges along x, y, z, or x, z, y; the other way at the other end.
    const bool odd = std::popcount(k) % 2 == 1;
    const std::array<unsigned, 3> axes = odd ? std::array{0u, 1u, 2u} : std::array{0u, 2u, 1u};
    const std::array<unsigned, 3> place_of_axis = odd ? std::array{0u, 2u, 1u} : std::array{0u, 1u, 2u};
    corners_[k] = {above(0) ? upper[0] : lower[0], above(1) ? upper[1] : lower[1],
                   above(2) ? upper[2] : lower[2]};
    for (std::uint32_t i = 0; i < 3; ++i) {
      const unsigned along = axes[i], across = axes[(i + 2) % 3];
      back_[half_edge(k, i)] = half_edge(k ^ 1u << along, place_of_axis[along]);
      face_[half_edge(k, i)] = 2 * across + above(across);
    }
  }
}

void ConvexCell::resize(std::size_t corners) {
  corners_.resize(corners);
  back_.resize(4 * corners);
  face_.resize(4 * corners);
}

/// Ends the edge between a corner that is cut off, which `inwards` leaves, and one that stays, in a new
/// `corner`. Its half-edges lead to the latter and, anticlockwise, twice along the cut, the last one in the
/// face to the left of `inwards`.
void ConvexCell::end_edge(HalfEdge inwards, std::uint32_t corner, std::uint32_t cap) {
  const HalfEdge outwards = back_[inwards];
  const std::uint32_t in = corner_of(outwards), out = corner_of(inwards);
  const double share = height_[in] / (height_[in] - height_[out]);
  corners_[corner] = corners_[in] + share * (corners_[out] - corners_[in]);
  back_[half_edge(corner, 0)] = outwards;
  face_[half_edge(corner, 0)] = face_[inwards];
  face_[half_edge(corner, 1)] = cap;
  face_[half_edge(corner, 2)] = face_[outwards];
  back_[outwards] = back_[inwards] = half_edge(corner, 0);
}

bool ConvexCell::cut(const Vector<3>& normal, double offset, Label label, double slack) {
  const auto before = static_cast<std::uint32_t>(corners_.size());
  height_.resize(before);
  bool beyond = false;
  for (std::uint32_t k = 0; k < before; ++k) {
    height_[k] = corners_[k].dot(normal) - offset;
    beyond |= height_[k] > slack;
  }
  if (!beyond) return false;

  cut_off_.clear();
  crossed_.clear();
  for (std::uint32_t k = 0; k < before; ++k)
    if (height_[k] > 0) cut_off_.push_back(k);
  for (const std::uint32_t corner : cut_off_)
    for (std::uint32_t k = 0; k < 3; ++k)
      if (const HalfEdge inwards = half_edge(corner, k); !(height_[corner_of(back_[inwards])] > 0))
        crossed_.push_back(inwards);
  const auto crossings = static_cast<std::uint32_t>(crossed_.size());
  resize(before + crossings);
  for (std::uint32_t k = 0; k < crossings; ++k)
    end_edge(crossed_[k], before + k, static_cast<std::uint32_t>(labels_.size()));
  labels_.push_back(label);
  // From the point where the cut leaves a face, along the removed corners, to the point where it enters it
  // again.
  for (std::uint32_t k = 0; k < crossings; ++k) {
    HalfEdge lost = clockwise(crossed_[k]);
    while (corner_of(back_[lost]) < before) lost = next_around_face(lost);
    const HalfEdge along = half_edge(before + k, 2), back = back_[lost] + 1;
    back_[along] = back;
    back_[back] = along;
  }
  // The last corners replace those that are cut off.
  auto left = before + crossings;
  for (std::size_t k = cut_off_.size(); k-- > 0;)
    if (--left != cut_off_[k]) move_corner(left, cut_off_[k]);
  resize(left);
  return true;
}

/// Precondition: no half-edge leads to the corner that is replaced.
void ConvexCell::move_corner(std::uint32_t from, std::uint32_t to) {
  corners_[to] = corners_[from];
  for (std::uint32_t k = 0; k < 3; ++k) {
    const HalfEdge moved = half_edge(to, k), back = back_[half_edge(from, k)];
    back_[moved] = back;
    back_[back] = moved;
    face_[moved] = face_[half_edge(from, k)];
  }
}

double ConvexCell::volume() const {
  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t>& apex = marks_;
  apex.assign(labels_.size(), none);
  double sum = 0;
  for (HalfEdge edge = 0; edge < half_edges(); ++edge) {
    if (!is_half_edge(edge)) continue;
    const std::uint32_t from = corner_of(edge);
    std::uint32_t& of_face = apex[face_[edge]];
    if (of_face == none) of_face = from;
    if (of_face == from) continue;  // zero volume
    sum += corners_[of_face].dot(corners_[from].cross(corners_[corner_of(back_[edge])]));
  }
  return sum / 6;
}

double ConvexCell::squared_reach() const {
  double farthest = 0;
  for (const Vector<3>& corner : corners_) farthest = std::max(farthest, corner.squaredNorm());
  return farthest;
}

/// Twice the area of every face, as an outward normal.
void ConvexCell::find_areas() const {
  areas_.assign(labels_.size(), Vector<3>::Zero());
  for (HalfEdge edge = 0; edge < half_edges(); ++edge)
    if (is_half_edge(edge))
      areas_[face_[edge]] += corners_[corner_of(edge)].cross(corners_[corner_of(back_[edge])]);
}

std::uint32_t ConvexCell::faces(double least) const {
  find_areas();
  double surface = 0;
  for (const Vector<3>& area : areas_) surface += area.norm();
  const double smallest = least * surface;
  std::uint32_t count = 0;
  for (std::size_t face = 0; face < labels_.size(); ++face)
    count += labels_[face] >= 0 && areas_[face].squaredNorm() > smallest * smallest;
  return count;
}

std::vector<ConvexCell::Plane> ConvexCell::planes() const {
  find_areas();
  std::vector<Plane> found;
  for (Vector<3>& area : areas_) {
    area.stableNormalize();
    found.push_back({area, -std::numeric_limits<double>::infinity()});
  }
  for (HalfEdge edge = 0; edge < half_edges(); ++edge) {
    if (!is_half_edge(edge)) continue;
    Plane& plane = found[face_[edge]];
    plane.offset = std::max(plane.offset, plane.normal.dot(corners_[corner_of(edge)]));
  }
  std::erase_if(found, [](const Plane& plane) { return plane.normal.isZero(0); });
  return found;
}

}  // namespace bernal
