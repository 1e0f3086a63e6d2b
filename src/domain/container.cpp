#include "bernal/domain/container.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "domain/analytic.hpp"
#include "domain/free_path.hpp"
#include "domain/wall_contacts.hpp"

namespace bernal {
namespace {

/// Whether the nearest point of a facet is on another one that comes nearer to the centre. Then it is no
/// nearest point of the wall as a whole: next to it, on the other facet, the wall comes nearer. This
/// happens where triangles or frustums share an edge or a corner; the pieces of analytic walls never share
/// their nearest points.
bool on_nearer_facet(const Vector<3>& q, std::size_t index, const std::vector<NearFacet>& near,
                     double tolerance) {
  if (!has_border(near[index].facet.kind)) return false;
  for (std::size_t k = 0; k < index; ++k) {
    if (has_border(near[k].facet.kind) && distance(near[k].facet, q) <= tolerance) return true;
  }
  return false;
}

/// The unit normal of the wall at q, the facet's point nearest to c, towards c.
Vector<3> inward_normal(const Facet& f, const Vector<3>& q, const Vector<3>& c, double d) {
  switch (f.kind) {
    case Facet::Kind::plane:
      return f.b;
    case Facet::Kind::cylinder:
    case Facet::Kind::sphere: {
      Vector<3> outward = q - f.a;
      if (f.kind == Facet::Kind::cylinder) outward -= outward.dot(f.b) * f.b;
      return -outward / f.radius;
    }
    case Facet::Kind::triangle:
    case Facet::Kind::frustum:
      break;
  }
  if (d > 0 && c != q) return (c - q).normalized();
  if (f.kind == Facet::Kind::frustum) {  // on it: the side is unknown, so towards the axis or along it
    const Vector<2> e(f.c[1] - f.c[0], f.c[2]);
    Vector<3> outward = q - f.a;
    outward -= outward.dot(f.b) * f.b;
    if (outward.squaredNorm() > 0) outward.normalize();
    const Vector<3> n = e[1] * outward - e[0] * f.b;
    return (e[1] > 0 ? Vector<3>(-n) : n).normalized();
  }
  return -(f.b - f.a).cross(f.c - f.a).normalized();
}

void require(bool holds, const char* message) {
  if (!holds) throw Error(ErrorCode::bad_argument, message);
}

bool is_length(double x) { return std::isfinite(x) && x > 0; }

}  // namespace

bool Container::few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                                std::vector<NearFacet>& out) const {
  const std::size_t before = out.size();
  facets_near(c, reach, out);
  return out.size() - before <= most;
}

void Container::contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const {
  thread_local std::vector<NearFacet> near;
  near.clear();
  facets_near(c, r, near);
  const std::size_t before = out.size();
  for (const NearFacet& n : near) {
    const Vector<3> offset = c - closest_point(n.facet, c);
    const double d = offset.norm();
    if (d < r && d > 0) out.push_back({offset / d, d});
  }
  leave_distinct(out, r, before);
}

double Container::first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                                double limit) const {
  const double skin = tolerance::skin(r, resolution_);
  thread_local std::vector<NearFacet> near;
  near.clear();
  facets_near(c, r + skin + limit, near);
  for (const NearFacet& n : near) {
    if (n.distance - r - skin >= limit) break;
    limit = bernal::first_contact(n.facet, c, r, direction, limit, skin);
  }
  return limit;
}

double Container::free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const {
  if (!(direction.stableNorm() > 0)) return contains(c, r) ? limit : 0;
  return free_path_among_near(*this, {c, r, direction, limit}, [&](const Facet& facet, const Motion& motion) {
    return bernal::free_path(facet, motion, arithmetic_);
  });
}

double Container::free_path_bound(const Vector<3>& c, double r) const {
  const Bounds<3> box = bounds();
  const double distance = std::max(box.size().norm(), (c - box.center()).norm());
  const double coordinate =
      std::max({box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  return rounding_bound(coordinate + 2 * distance + r);
}

void Container::walls_near(const Vector<3>& c, double reach, std::vector<WallPoint>& out) const {
  thread_local std::vector<NearFacet> near;
  near.clear();
  facets_near(c, reach, near);
  // Triangles share edges and corners, and the walls inside of them do not where they stand behind.
  for (NearFacet& n : near)
    if (has_border(n.facet.kind)) n.facet.radius = 0;
  // A nearest point is known to a few resolutions, and so is its distance from another facet.
  const double tolerance = 32 * resolution_;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Vector<3> q = closest_point(near[i].facet, c);
    if (on_nearer_facet(q, i, near, tolerance)) continue;
    out.push_back({q, inward_normal(near[i].facet, q, c, near[i].distance), near[i].distance});
  }
}

std::unique_ptr<Container> make_analytic_container(const Domain& shape, WallArithmetic arithmetic,
                                                   double resolution) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    const int dimension = box->dimension();
    require((dimension == 2 || dimension == 3) && box->corner.size() == dimension,
            "a container has two or three dimensions");
    require(box->periodic.empty() || box->periodic.size() == static_cast<std::size_t>(dimension),
            "a box repeats itself or ends on each of its axes");
    require(box->corner.allFinite() && std::ranges::all_of(box->size, is_length),
            "a box needs positive edges and a finite corner");
    return make_box(*box, arithmetic, resolution);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    require(is_length(cylinder->radius) && is_length(cylinder->height) && cylinder->base.allFinite(),
            "a cylinder needs a positive radius and height and a finite base");
    require(cylinder->axis.allFinite() && !cylinder->axis.isZero(0),
            "a cylinder needs an axis that is finite and not zero");
    require(!cylinder->periodic || cylinder->coordinate_axis() >= 0,
            "a cylinder that repeats itself needs an axis along x, y or z");
    return make_cylinder(*cylinder, arithmetic, resolution);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    require(is_length(sphere->radius) && sphere->center.allFinite(),
            "a sphere needs a positive radius and a finite center");
    return make_sphere(*sphere, arithmetic, resolution);
  }
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    require_simple(*polygon);
    return make_polygon(*polygon, arithmetic, resolution);
  }
  if (const auto* revolved = std::get_if<Revolved>(&shape)) {
    require_profile(*revolved);
    return make_revolved(*revolved, arithmetic, resolution);
  }
  throw Error(ErrorCode::bad_argument, "a mesh is no analytic container: use make_mesh_container");
}

}  // namespace bernal
