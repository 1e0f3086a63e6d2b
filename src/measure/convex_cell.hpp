#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A convex polyhedron from which half-spaces are cut off, in coordinates about a point of its own.
///
/// Three edges meet in every corner: in a place where more do, as many corners coincide as are needed for
/// that. Edges lead from corner to corner and around every face, and a cut takes out corners, ends the edges
/// that led to them in new ones, and joins these around what it has opened. So the surface is closed after
/// every cut, however rounding has taken the sides of corners, and volumes are exact to rounding, without a
/// tolerance anywhere.
class ConvexCell {
 public:
  /// What a face is of: as its owner says. Below 0 it is of no neighbour.
  using Label = std::int32_t;
  static constexpr Label wall = -1;

  /// Begins anew as a box, the label of whose sides across each axis is given. Precondition: lower < upper,
  /// about zero or not.
  void reset(const Vector<3>& lower, const Vector<3>& upper, const std::array<Label, 3>& sides);

  /// Leaves the points p with p·normal <= offset. Corners on the plane stay. False, and nothing is done,
  /// where no corner has p·normal > offset + slack. Cost: some 2 ns a corner, and 20 one that is cut off.
  bool cut(const Vector<3>& normal, double offset, Label label, double slack = 0);

  bool empty() const { return corners_.empty(); }
  std::span<const Vector<3>> corners() const { return corners_; }
  /// Calls visit(corners) for every loop of every face, anticlockwise as seen from outside.
  template <class Visit>
  void for_each_loop(Visit&& visit) const;

  double volume() const;
  /// Of the faces that have an area: the cell is where p·normal <= offset.
  struct Plane {
    Vector<3> normal;  ///< of length 1, outwards
    double offset;
  };
  std::vector<Plane> planes() const;
  /// The largest distance of a corner from the origin, squared.
  double squared_reach() const;
  /// How many faces of neighbours have more than `least` of the surface.
  std::uint32_t faces(double least) const;

 private:
  /// An edge as it leaves a corner: the number of that, and which of three it is there, anticlockwise as seen
  /// from outside. Its face is the one to its left.
  using Way = std::uint32_t;
  static Way way(std::size_t corner, std::uint32_t k) { return static_cast<Way>(4 * corner + k); }
  static std::uint32_t corner_of(Way way) { return way / 4; }
  static Way clockwise(Way way) { return way % 4 > 0 ? way - 1 : way + 2; }
  Way next_around_face(Way way) const { return clockwise(back_[way]); }
  std::size_t ways() const { return back_.size(); }
  static bool is_way(std::size_t way) { return way % 4 != 3; }

  void resize(std::size_t corners);
  void end_edge(Way inwards, std::uint32_t corner, std::uint32_t cap);
  void move_corner(std::uint32_t from, std::uint32_t to);
  void find_areas() const;

  std::vector<Vector<3>> corners_;
  std::vector<Way> back_;            ///< of every way: the one that leads back
  std::vector<std::uint32_t> face_;  ///< of every way: of `labels_`
  std::vector<Label> labels_;

  // Of one call, kept for their memory.
  std::vector<double> height_;
  std::vector<std::uint32_t> cut_off_;
  std::vector<Way> crossed_;
  mutable std::vector<std::uint32_t> marks_, loop_;
  mutable std::vector<Vector<3>> areas_;
};

template <class Visit>
void ConvexCell::for_each_loop(Visit&& visit) const {
  marks_.assign(ways(), 0);
  for (Way first = 0; first < ways(); ++first) {
    if (!is_way(first) || marks_[first] != 0) continue;
    loop_.clear();
    for (Way way = first; marks_[way] == 0; way = next_around_face(way)) {
      marks_[way] = 1;
      loop_.push_back(corner_of(way));
    }
    visit(std::span<const std::uint32_t>(loop_));
  }
}

}  // namespace bernal
