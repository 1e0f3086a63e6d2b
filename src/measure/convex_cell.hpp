#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A convex polyhedron from which half-spaces are cut off, in coordinates about a point of its own.
///
/// Three edges meet in every corner; where more do, several corners coincide. Edges connect corners and run
/// around every face; a cut removes corners, ends the edges to them in new corners, and joins these around
/// the opening. So the surface is closed after every cut, whatever rounding does to the sides of corners, and
/// volumes are exact to rounding without any tolerance.
class ConvexCell {
 public:
  /// Identifies the owner of a face, as the caller defines it. Negative labels are not neighbours.
  using Label = std::int64_t;
  static constexpr Label wall = -1;

  /// Resets to a box, with a label for each side: below and above along x, then along y and z. Precondition:
  /// lower < upper.
  void reset(const Vector<3>& lower, const Vector<3>& upper, const std::array<Label, 6>& sides);

  /// Keeps the points p with p·normal <= offset. Corners on the plane stay. Returns false, without change, if
  /// no corner has p·normal > offset + slack. Cost: about 2 ns a corner, and 20 for each that is cut off.
  bool cut(const Vector<3>& normal, double offset, Label label, double slack = 0);

  bool empty() const { return corners_.empty(); }
  std::span<const Vector<3>> corners() const { return corners_; }
  /// Calls visit(corners) for every loop of every face, anticlockwise seen from outside.
  template <class Visit>
  void for_each_loop(Visit&& visit) const {
    for_each_face([&](Label, std::span<const std::uint32_t> corners) { visit(corners); });
  }
  /// The same, with the label of the face: visit(label, corners).
  template <class Visit>
  void for_each_face(Visit&& visit) const;

  double volume() const;
  /// The planes of faces with an area: the cell is where p·normal <= offset.
  struct Plane {
    Vector<3> normal;  ///< of length 1, outwards
    double offset;
  };
  std::vector<Plane> planes() const;
  /// The largest distance of a corner from the origin, squared.
  double squared_reach() const;
  /// Number of faces of neighbours with more than the share `least` of the surface.
  std::uint32_t faces(double least) const;

 private:
  /// A directed edge: the number of its corner, and its index among the corner's three edges, anticlockwise
  /// seen from outside. Its face is on its left.
  using HalfEdge = std::uint32_t;
  static HalfEdge half_edge(std::size_t corner, std::uint32_t k) {
    return static_cast<HalfEdge>(4 * corner + k);
  }
  static std::uint32_t corner_of(HalfEdge edge) { return edge / 4; }
  static HalfEdge clockwise(HalfEdge edge) { return edge % 4 > 0 ? edge - 1 : edge + 2; }
  HalfEdge next_around_face(HalfEdge edge) const { return clockwise(back_[edge]); }
  std::size_t half_edges() const { return back_.size(); }
  static bool is_half_edge(std::size_t edge) { return edge % 4 != 3; }

  void resize(std::size_t corners);
  void end_edge(HalfEdge inwards, std::uint32_t corner, std::uint32_t cap);
  void move_corner(std::uint32_t from, std::uint32_t to);
  void find_areas() const;

  std::vector<Vector<3>> corners_;
  std::vector<HalfEdge> back_;       ///< for every half-edge, the opposite half-edge
  std::vector<std::uint32_t> face_;  ///< for every half-edge, an index into `labels_`
  std::vector<Label> labels_;

  // Scratch memory of one call.
  std::vector<double> height_;
  std::vector<std::uint32_t> cut_off_;
  std::vector<HalfEdge> crossed_;
  mutable std::vector<std::uint32_t> marks_, loop_;
  mutable std::vector<Vector<3>> areas_;
};

template <class Visit>
void ConvexCell::for_each_face(Visit&& visit) const {
  marks_.assign(half_edges(), 0);
  for (HalfEdge first = 0; first < half_edges(); ++first) {
    if (!is_half_edge(first) || marks_[first] != 0) continue;
    loop_.clear();
    for (HalfEdge edge = first; marks_[edge] == 0; edge = next_around_face(edge)) {
      marks_[edge] = 1;
      loop_.push_back(corner_of(edge));
    }
    visit(labels_[face_[first]], std::span<const std::uint32_t>(loop_));
  }
}

}  // namespace bernal
