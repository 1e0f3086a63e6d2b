#include "bernal/domain/facet.hpp"

#include <algorithm>

#include "domain/frustum.hpp"
#include "kernels/closest_point.hpp"
#include "kernels/first_contact.hpp"

namespace bernal {
namespace {

Vector<3> radial(const Facet& f, const Vector<3>& p) {
  const Vector<3> w = p - f.a;
  if (f.kind == Facet::Kind::cylinder) return w - w.dot(f.b) * f.b;
  return w;
}

/// Any direction that is radial for the facet, for a point that has none of its own.
Vector<3> any_radial(const Facet& f) {
  if (f.kind == Facet::Kind::sphere) return Vector<3>::UnitX();
  return f.b.unitOrthogonal();
}

Vector<3> closest_point_of_frustum(const Facet& f, const Vector<3>& p) {
  const Vector<3> w = p - f.a;
  const double z = w.dot(f.b);
  const Vector<3> across = w - z * f.b;
  const double r = across.norm();
  const Vector<2> nearest = nearest_of_edge({r, z}, {f.c[0], 0}, {f.c[1], f.c[2]});
  const Vector<3> outward = r > 0 ? Vector<3>(across / r) : f.b.unitOrthogonal();
  return p + (nearest[0] - r) * outward + (nearest[1] - z) * f.b;
}

}  // namespace

double distance(const Facet& f, const Vector<3>& p) {
  switch (f.kind) {
    case Facet::Kind::plane:
      return (p - f.a).dot(f.b);
    case Facet::Kind::cylinder:
    case Facet::Kind::sphere:
      return f.radius - radial(f, p).norm();
    case Facet::Kind::frustum: {
      const Vector<2> at = in_half_plane(p, f.a, f.b);
      return (at - nearest_of_edge(at, {f.c[0], 0}, {f.c[1], f.c[2]})).norm() - f.radius;
    }
    case Facet::Kind::triangle:
      break;
  }
  return PreparedTriangle(f.a, f.b, f.c).offset(p).norm() - f.radius;
}

Vector<3> closest_point(const Facet& f, const Vector<3>& p) {
  switch (f.kind) {
    case Facet::Kind::plane:
      return p - (p - f.a).dot(f.b) * f.b;
    case Facet::Kind::cylinder:
    case Facet::Kind::sphere: {
      const Vector<3> w = radial(f, p);
      const double length = w.norm();
      const Vector<3> outward = length > 0 ? Vector<3>(w / length) : any_radial(f);
      return p + (f.radius - length) * outward;
    }
    case Facet::Kind::triangle:
    case Facet::Kind::frustum:
      break;
  }
  const Vector<3> nearest = f.kind == Facet::Kind::frustum ? closest_point_of_frustum(f, p)
                                                           : closest_point_of_triangle(p, f.a, f.b, f.c);
  if (f.radius == 0) return nearest;
  const Vector<3> away = p - nearest;
  const double length = away.norm();
  return length > 0 ? Vector<3>(nearest + f.radius / length * away) : nearest;
}

double first_contact(const Facet& f, const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                     double skin) {
  switch (f.kind) {
    case Facet::Kind::plane:
      return first_contact_with_plane(c, r, direction, limit, f.a, f.b, skin);
    case Facet::Kind::cylinder:
      return first_contact_inside_cylinder(c, r, direction, limit, f.a, f.b, f.radius, skin);
    case Facet::Kind::sphere:
      return first_contact_inside_sphere(c, r, direction, limit, f.a, f.radius, skin);
    case Facet::Kind::frustum:
      return first_contact_with_frustum(edge_of(f), c, std::max(0.0, r + f.radius), direction, limit, skin);
    case Facet::Kind::triangle:
      break;
  }
  return first_contact_with_triangle(c, std::max(0.0, r + f.radius), direction, limit, f.a, f.b, f.c, skin);
}

}  // namespace bernal
