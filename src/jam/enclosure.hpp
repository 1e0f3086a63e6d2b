#pragma once
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "bernal/domain/container.hpp"
#include "core/made.hpp"
#include "kernels/closest_point.hpp"

namespace bernal {

/// The points p with (p - point)·inward >= 0.
template <int D>
struct PlaneWall {
  Vector<D> point, inward;
};

/// A triangle of a wall that is displaced inwards by `inset`.
struct TriangleWall {
  Vector<3> a, b, c;
  PreparedTriangle prepared;
  double inset;
};

/// A smooth piece of the walls. In the plane a triangle is an edge of a polygon, on z = 0; in other than two
/// and three dimensions all are planes.
template <int D>
using WallPiece = std::variant<PlaneWall<D>, Facet, TriangleWall>;

/// A piece of wall relative to a point.
template <int D>
struct WallView {
  Vector<D> normal;  // from the wall
  double distance;   // signed, except for a triangle
};

/// The walls around soft spheres that are to jam: those of a container, or of a box with walls along some of
/// its axes.
///
/// Every triangle of a mesh is a piece of its own with its true distance, whose slope is continuous; so is
/// that of a sum over pieces when a sphere rolls from one to the next. Two triangles with the same nearest
/// point, on an edge or corner, are two pieces of one contact.
template <int D>
class Enclosure {
 public:
  /// For a box [0, edges) with walls along some axes.
  Enclosure(const Vector<D>& edges, const std::vector<bool>& walls);
  /// Precondition: the container has D dimensions.
  explicit Enclosure(const Container& container) requires(D == 2 || D == 3);

  /// Appends the pieces nearer than `reach` to p, nearest first, possibly with some that are farther.
  void pieces_near(const Vector<D>& p, double reach, std::vector<WallPiece<D>>& out) const;

  /// Nearest points no farther apart than this are the same.
  double same_place() const { return same_place_; }

 private:
  Made made_{"walls"};
  std::vector<PlaneWall<D>> planes_;
  const Container* container_ = nullptr;
  double same_place_ = 0;
};

template <int D>
WallView<D> view_of(const WallPiece<D>& piece, const Vector<D>& p);

/// The second derivative of the distance, times the distance: zero at a plane, the projection normal to the
/// normal at a corner, negative along the curve of a round wall. At its discontinuities, on the border
/// between a triangle's face and its edges, either value.
template <int D>
Eigen::Matrix<double, D, D> bend_of(const WallPiece<D>& piece, const Vector<D>& p, const WallView<D>& view);

}  // namespace bernal
