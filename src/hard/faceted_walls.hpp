#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "kernels/closest_point.hpp"
#include "near/box_tree.hpp"

namespace bernal {

/// A point of two dimensions with z = 0, one of three as it is; of more nobody asks.
template <int D>
Vector<3> point_in_space(const Vector<D>& p) {
  Vector<3> all = Vector<3>::Zero();
  if constexpr (D <= 3) all.template head<D>() = p;
  return all;
}

/// The walls of a container of two or three dimensions, convex or not, for spheres that fly and grow in it:
/// the triangles of a mesh, the edges of a polygon, and in place of a solid of revolution triangles inside of
/// it. Points of two dimensions are those with z = 0.
///
/// A sphere at p + v t with the radius r + r' t touches a facet when f(t) = d(p + v t) - r - r' t becomes 0,
/// d being the distance from the facet, its borders with it. A triangle is convex, so d and f are convex
/// functions of t, and Newton's steps from the left never pass the first root. So a face, an edge that stands
/// into the container and the corner of one need no rules of their own, and nothing has to say which facets
/// are one face: at the border of two they stop a sphere at the same distance. Near a face one step suffices,
/// at an edge some do.
///
/// Invariant: no sphere comes nearer to a facet than its radius, but for rounding. Where the wall stands
/// inside of the facets, by an inset, no nearer to the wall; where it stands behind them they count
/// themselves.
class FacetedWalls {
 public:
  using Id = std::uint32_t;
  struct Near {
    using ArchivedAsBytes = void;
    Vector<3> normal;  ///< from the facet to the point that asked
    double clearance;  ///< of that point
    Id facet;
  };

  /// `shift`: from the coordinates of the shape to those of the spheres. Facets of a solid of revolution are
  /// inside of it by up to `tolerance`. Cost: about a microsecond a facet.
  FacetedWalls(const Domain& shape, double tolerance, const Vector<3>& shift);

  /// The facets nearer than `reach`, nearest first, in place of what `out` holds. Cost: O(log facets), and 20
  /// ns a facet that is about as near.
  void find_near(const Vector<3>& p, double reach, std::vector<Near>& out) const;

  /// As `Wall::time_to_touch`; infinite where that is `limit` or later. Cost: 30 ns a step.
  double time_to_touch(Id facet, const Vector<3>& p, const Vector<3>& v, double r, double growth,
                       double limit) const;
  /// The unit normal out of the container where a sphere at p touches.
  Vector<3> outward(Id facet, const Vector<3>& p) const { return -facets_[facet].offset(p).normalized(); }

 private:
  void add(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c);

  double inset_ = 0;
  double extent_ = 0;  // of the coordinates
  std::vector<PreparedTriangle> facets_;
  std::vector<Bounds<3>> bounds_;
  BoxTree<3> tree_;
};

}  // namespace bernal
