#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "solids/pieces.hpp"

namespace bernal {

/// A closed convex part with flat faces, which cuts spheres. Faces, edges and corners name each other by
/// their numbers.
struct ConvexPart {
  struct Face {
    HalfSpace keeps;
    int axis = -1;     ///< the coordinate axis across which it lies, or -1
    double level = 0;  ///< the coordinate along that axis that all its points have exactly
    std::vector<std::uint32_t> corners = {};  ///< anticlockwise seen from outside
    std::vector<std::uint32_t> edges = {};
    Vector<3> origin = Vector<3>::Zero();                      ///< about its middle
    Vector<3> u = Vector<3>::UnitX(), v = Vector<3>::UnitY();  ///< unit, in the face, perpendicular
    bool is_turned = false;  ///< the cross product of u and v points inwards

    /// Whether a point of its plane lies in it.
    bool holds(const Vector<3>& on_plane, const ConvexPart&) const;
  };
  struct Edge {
    std::array<std::uint32_t, 2> corners = {};
    std::array<std::uint32_t, 2> faces = {};
    Vector<3> along = Vector<3>::UnitZ();  ///< unit, from the first corner to the second
  };
  struct Corner {
    Vector<3> point = Vector<3>::Zero();
    std::vector<std::uint32_t> faces = {};
  };
  std::vector<Face> faces = {};
  std::vector<Edge> edges = {};
  std::vector<Corner> corners = {};
  bool is_box = false;  ///< with faces numbered as Cut::face has those of periods

  /// How far a point is outside of the plane that it is farthest beyond; negative inside.
  double height(const Vector<3>&) const;
  /// 0 inside. Cost: O(faces).
  double distance(const Vector<3>&) const;
  /// The edge between two faces; none if they have no edge in common.
  std::optional<std::uint32_t> edge_between(std::uint32_t face, std::uint32_t other) const;
  /// Gives a point that lies on a face to rounding the coordinate that its points have exactly, if any.
  void put_on(std::uint32_t face, Vector<3>& p) const {
    if (faces[face].axis >= 0) p[faces[face].axis] = faces[face].level;
  }
  Bounds<3> bounds() const;
  /// The box, else a mesh of its faces.
  Domain domain() const;
};

/// The box [lower, lower + (upper - lower)]. Throws Error{bad_argument} if it holds nothing.
ConvexPart part_of_box(const Bounds<3>&);

/// What all half-spaces have in common; those that cut nothing off are left out. `around`: as much of space
/// as may matter. Throws Error{bad_argument} if that is nothing, or not closed within there.
ConvexPart part_between(std::span<const HalfSpace>, const Bounds<3>& around);

/// The part that a mesh bounds, with triangles in one plane joined to faces: to within the single precision
/// that files have. Throws Error{bad_argument} with the place where it is not convex or not closed. Cost:
/// O(T log T), and corners times faces.
ConvexPart part_bounded_by(const Mesh&);

/// The part of a ball in a convex part, cut by the planes of its faces that cut the ball; nothing if there is
/// none. Cost: O(faces).
std::optional<Piece> piece_in(const ConvexPart&, const Vector<3>& center, double radius);

/// The volume of a piece in closed form, see `volume_inside`. Cost: 1 µs a cut.
double volume_of(const Piece&);

}  // namespace bernal
