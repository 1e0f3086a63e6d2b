#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A convex polyhedron from which half-spaces are cut off, in coordinates about a point of its own.
///
/// Every face is a set of directed edges that form loops, each edge once in either direction over all faces:
/// that holds after every cut, however rounding has taken the sides of corners, and so volumes are those of
/// closed surfaces, to rounding, without a tolerance anywhere.
class ConvexCell {
 public:
  struct Corner {
    Vector<3> point;
  };
  /// What a face is of: as its owner says. Below 0 it is of no neighbour.
  using Label = std::int32_t;
  static constexpr Label wall = -1;
  static constexpr std::uint32_t top = 5;  ///< the face with which the box ends along the last axis

  struct Edge {
    std::uint32_t from, to;  ///< corners
    std::uint32_t face;      ///< of `labels`
  };

  /// Begins anew as a box, the label of whose sides across each axis is given. Precondition: lower < upper,
  /// about zero or not.
  void reset(const Vector<3>& lower, const Vector<3>& upper, const std::array<Label, 3>& sides);

  /// Leaves the points p with p·normal <= offset. Corners on the plane stay. False, and nothing is done,
  /// where no corner has p·normal > offset + slack. Cost: O(edges), about 0.2 µs.
  bool cut(const Vector<3>& normal, double offset, Label label, double slack = 0);

  bool empty() const { return edges_.empty(); }
  std::span<const Corner> corners() const { return corners_; }
  std::span<const Edge> edges() const { return edges_; }

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
  void find_areas() const;
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b);
  void drop_unused_corners();

  std::vector<Corner> corners_;
  std::vector<Edge> edges_;
  std::vector<Label> labels_;

  // Of one cut, kept for their memory.
  std::vector<double> height_;
  struct Crossing {
    std::uint32_t low, high, corner;
  };
  std::vector<Crossing> crossings_;
  struct Open {
    std::uint32_t face, corner;
  };
  std::vector<Open> exits_, entries_;
  std::vector<Edge> kept_;
  mutable std::vector<std::uint32_t> numbers_;
  mutable std::vector<Vector<3>> areas_;
};

}  // namespace bernal
