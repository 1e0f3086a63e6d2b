#include "jam/enclosure.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "core/every_dimension.hpp"

namespace bernal {
namespace {

/// Of a mesh, in units of its coordinates: rounding of a nearest point.
constexpr double rounding_of_place = 64;
/// Cosine between an edge and what is square to it.
constexpr double square = 1e-9;
/// Squared distances from a face and its edges that differ by less are one.
constexpr double same_distance = 1e-12;

WallView<3> view_of_facet(const Facet& facet, const Vector<3>& p) {
  const double d = distance(facet, p);
  if (facet.kind == Facet::Kind::plane) return {facet.b, d};
  if (facet.kind == Facet::Kind::frustum) {
    Facet piece = facet;
    piece.radius = 0;
    return {(p - closest_point(piece, p)).stableNormalized(), d};
  }
  Vector<3> inward = facet.a - p;
  if (facet.kind == Facet::Kind::cylinder) inward -= inward.dot(facet.b) * facet.b;
  return {inward.stableNormalized(), d};
}

Eigen::Matrix3d across(const Vector<3>& normal) {
  return Eigen::Matrix3d::Identity() - normal * normal.transpose();
}

/// About the axis the distance d from a frustum bends as that from it, r: by n_r / r across the half plane in
/// which r and the nearest point lie. In that half plane it does not, unless the nearest point is an end of
/// the edge; there it bends as that from a point.
Eigen::Matrix3d bend_of_frustum(const Facet& facet, const Vector<3>& p, const WallView<3>& view) {
  Vector<3> outward = p - facet.a;
  const double z = outward.dot(facet.b);
  outward -= z * facet.b;
  const double r = outward.norm();
  Eigen::Matrix3d bend = Eigen::Matrix3d::Zero();
  const double distance = view.distance + facet.radius;
  if (!(r > 0) || !(distance > 0)) return bend;
  outward /= r;
  const Vector<3> around = facet.b.cross(outward);
  bend += view.normal.dot(outward) / r * around * around.transpose();
  const Vector<2> from(facet.c[0], 0), to(facet.c[1], facet.c[2]), e = to - from, w = Vector<2>(r, z) - from;
  const double along = w.dot(e);
  if (along < 0 || along > e.squaredNorm()) {
    const Vector<3> turned = around.cross(view.normal);
    bend += turned * turned.transpose() / distance;
  }
  return view.distance * bend;
}

/// Of a round wall the distance falls as the distance from its axis or centre, R - d, grows.
Eigen::Matrix3d bend_of_facet(const Facet& facet, const Vector<3>& p, const WallView<3>& view) {
  if (facet.kind == Facet::Kind::plane) return Eigen::Matrix3d::Zero();
  if (facet.kind == Facet::Kind::frustum) return bend_of_frustum(facet, p, view);
  Eigen::Matrix3d bend = across(view.normal);
  if (facet.kind == Facet::Kind::cylinder) bend -= facet.b * facet.b.transpose();
  const double from_middle = facet.radius - view.distance;
  return from_middle > 0 ? Eigen::Matrix3d(-view.distance / from_middle * bend) : Eigen::Matrix3d::Zero();
}

/// A face is flat, an edge bends across itself and a corner all ways; a wall inside of them as they do, and
/// its distance is another.
Eigen::Matrix3d bend_of_triangle(const TriangleWall& wall, const Vector<3>& p, const WallView<3>& view) {
  const Vector<3>* const corners[] = {&wall.a, &wall.b, &wall.c};
  Vector<3> nearest = Vector<3>::Zero(), along = nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vector<3>&from = *corners[k], &to = *corners[(k + 1) % 3];
    const Vector<3> offset = offset_from_segment(p, from, to);
    if (!(offset.squaredNorm() < least)) continue;
    least = offset.squaredNorm();
    nearest = offset;
    along = to - from;
  }
  const double distance = view.distance + wall.inset;
  if (distance * distance < (1 - same_distance) * least) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d bend = across(view.normal);
  if (std::abs(nearest.dot(along)) <= square * nearest.norm() * along.norm())
    bend -= along * along.transpose() / along.squaredNorm();
  if (wall.inset != 0) bend *= view.distance / distance;
  return bend;
}

/// A place or direction of the plane z = 0 in space, as containers of two dimensions have them.
template <int D>
Vector<3> in_space(const Vector<D>& v) {
  Vector<3> all = Vector<3>::Zero();
  all.head<D>() = v;
  return all;
}

/// Of other pieces than `PlaneWall`.
template <class Piece>
WallView<3> view_in_space(const Piece& piece, const Vector<3>& p) {
  if (const auto* facet = std::get_if<Facet>(&piece)) return view_of_facet(*facet, p);
  const auto& wall = std::get<TriangleWall>(piece);
  const Vector<3> away = wall.prepared.offset(p);
  const double distance = away.norm();
  return {away / distance, distance - wall.inset};
}

}  // namespace

template <int D>
Enclosure<D>::Enclosure(const Vector<D>& edges, const std::vector<bool>& walls) {
  for (int k = 0; k < D; ++k) {
    if (walls.empty() || !walls[static_cast<std::size_t>(k)]) continue;
    planes_.push_back({Vector<D>::Zero(), Vector<D>::Unit(k)});
    planes_.push_back({edges, -Vector<D>::Unit(k)});
  }
}

template <int D>
Enclosure<D>::Enclosure(const Container& container) requires(D == 2 || D == 3)
    : container_(&container), same_place_(rounding_of_place * container.resolution()) {}

template <int D>
void Enclosure<D>::pieces_near(const Vector<D>& p, double reach, std::vector<WallPiece<D>>& out) const {
  for (const PlaneWall<D>& plane : planes_)
    if ((p - plane.point).dot(plane.inward) < reach) out.push_back(plane);
  if constexpr (D == 2 || D == 3) {
    if (!container_) return;
    thread_local std::vector<NearFacet> near;
    near.clear();
    container_->facets_near(in_space<D>(p), reach, near);
    for (const auto& [distance, facet] : near) {
      if (facet.kind == Facet::Kind::triangle)
        out.push_back(TriangleWall{facet.a, facet.b, facet.c, {facet.a, facet.b, facet.c}, facet.radius});
      else
        out.push_back(facet);
    }
  }
}

template <int D>
WallView<D> view_of(const WallPiece<D>& piece, const Vector<D>& p) {
  if (const auto* plane = std::get_if<PlaneWall<D>>(&piece))
    return {plane->inward, (p - plane->point).dot(plane->inward)};
  if constexpr (D == 2 || D == 3) {
    const WallView<3> view = view_in_space(piece, in_space<D>(p));
    return {view.normal.template head<D>(), view.distance};
  }
  return {Vector<D>::Zero(), 0};  // there are no others
}

template <int D>
Eigen::Matrix<double, D, D> bend_of(const WallPiece<D>& piece, const Vector<D>& p, const WallView<D>& view) {
  if constexpr (D == 2 || D == 3) {
    const WallView<3> seen{in_space<D>(view.normal), view.distance};
    if (const auto* facet = std::get_if<Facet>(&piece))
      return bend_of_facet(*facet, in_space<D>(p), seen).template topLeftCorner<D, D>();
    if (const auto* triangle = std::get_if<TriangleWall>(&piece))
      return bend_of_triangle(*triangle, in_space<D>(p), seen).template topLeftCorner<D, D>();
  }
  return Eigen::Matrix<double, D, D>::Zero();
}

#define BERNAL_INSTANTIATE(D)                                             \
  template class Enclosure<D>;                                            \
  template WallView<D> view_of<D>(const WallPiece<D>&, const Vector<D>&); \
  template Eigen::Matrix<double, D, D> bend_of<D>(const WallPiece<D>&, const Vector<D>&, const WallView<D>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
