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

/// One triangle of a wall, which stands so far inside of it.
struct TriangleWall {
  Vector<3> a, b, c;
  PreparedTriangle prepared;
  double inset;
};

/// One smooth piece of the walls; in other than three dimensions all of them are planes.
template <int D>
using WallPiece = std::variant<PlaneWall<D>, Facet, TriangleWall>;

/// A piece of wall as a point sees it.
template <int D>
struct WallView {
  Vector<D> normal;  // from the wall
  double distance;   // signed, but of a triangle
};

/// The walls around soft spheres that are to jam: those of a container, or of a box that ends at walls along
/// some of its axes.
///
/// Every triangle of a mesh is a piece of its own, and its distance the true one, whose slope is continuous:
/// so is that of a sum over pieces, wherever a sphere rolls from one to the next. Two triangles whose nearest
/// point is one and the same, on an edge or corner, are two pieces of one contact.
template <int D>
class Enclosure {
 public:
  /// Of a box [0, edges) that ends at walls along some axes.
  Enclosure(const Vector<D>& edges, const std::vector<bool>& walls);
  explicit Enclosure(const Container& container) requires(D == 3);

  /// Appends what is nearer than `reach` to p, nearest first, if not a few that are farther.
  void pieces_near(const Vector<D>& p, double reach, std::vector<WallPiece<D>>& out) const;

  /// Nearest points that are no farther apart are one.
  double same_place() const { return same_place_; }

 private:
  Made made_{"walls"};
  std::vector<PlaneWall<D>> planes_;
  const Container* container_ = nullptr;
  double same_place_ = 0;
};

template <int D>
WallView<D> view_of(const WallPiece<D>& piece, const Vector<D>& p);

/// The second derivative of the distance, times the distance: zero at a plane, the projection on what is
/// across the normal at a corner, negative along the curve of a round wall. On the border of a triangle's
/// face and its edges, where it jumps, either.
template <int D>
Eigen::Matrix<double, D, D> bend_of(const WallPiece<D>& piece, const Vector<D>& p, const WallView<D>& view);

}  // namespace bernal
