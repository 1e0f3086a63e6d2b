#include "cad/opencascade/face_triangles.hpp"

#include <ElSLib.hxx>
#include <algorithm>
#include <unordered_map>
#include <utility>

namespace bernal::cad {
namespace {

/// The nearest parameters to p, in closed form; false if the surface type has none.
bool nearest_parameters(const BRepAdaptor_Surface& surface, const gp_Pnt& p, gp_XY& at) {
  double u = 0, v = 0;
  switch (surface.GetType()) {
    case GeomAbs_Plane:
      ElSLib::Parameters(surface.Plane(), p, u, v);
      break;
    case GeomAbs_Cylinder:
      ElSLib::Parameters(surface.Cylinder(), p, u, v);
      break;
    case GeomAbs_Cone:
      ElSLib::Parameters(surface.Cone(), p, u, v);
      break;
    case GeomAbs_Sphere:
      ElSLib::Parameters(surface.Sphere(), p, u, v);
      break;
    case GeomAbs_Torus:
      ElSLib::Parameters(surface.Torus(), p, u, v);
      break;
    default:
      return false;
  }
  at = {u, v};
  return true;
}

/// From p to the surface's nearest point, in closed form or by Gauss-Newton from nearby parameters. Any point
/// of the surface bounds the distance, so the nearest of the iterates is taken.
Vector<3> offset_of_surface(const BRepAdaptor_Surface& surface, gp_XY at, const Vector<3>& p) {
  constexpr int steps = 6;
  if (nearest_parameters(surface, {p[0], p[1], p[2]}, at))
    return vector_of(surface.Value(at.X(), at.Y())) - p;
  Vector<3> best = Vector<3>::Zero();
  for (int k = 0; k < steps; ++k) {
    gp_Pnt point;
    gp_Vec along_u, along_v;
    surface.D1(at.X(), at.Y(), point, along_u, along_v);
    const Vector<3> offset = vector_of(point) - p;
    const double before = best.squaredNorm(), now = offset.squaredNorm();
    if (k == 0 || now < before) best = offset;
    if (k > 0 && !(now < 0.99 * before)) break;
    const Vector<3> du = {along_u.X(), along_u.Y(), along_u.Z()},
                    dv = {along_v.X(), along_v.Y(), along_v.Z()};
    const double uu = du.dot(du), uv = du.dot(dv), vv = dv.dot(dv), determinant = uu * vv - uv * uv;
    const double u = -du.dot(offset), v = -dv.dot(offset);
    if (!(determinant > 1e-12 * uu * vv)) break;
    at += gp_XY((vv * u - uv * v) / determinant, (uu * v - uv * u) / determinant);
    at.SetX(std::clamp(at.X(), surface.FirstUParameter(), surface.LastUParameter()));
    at.SetY(std::clamp(at.Y(), surface.FirstVParameter(), surface.LastVParameter()));
  }
  return best;
}

using Corners = FaceTriangles::Corners;

/// Calls visit(a, b, c, offset) at fifteen points of a triangle: their barycentric weights and the offset to
/// the surface.
template <typename Visit>
void for_each_offset(const BRepAdaptor_Surface& surface, const FaceTriangles& face, const Corners& corners,
                     const Visit& visit) {
  constexpr int fineness = 4;
  const auto& [i, j, k] = corners;
  for (int m = 0; m <= fineness; ++m) {
    for (int n = 0; m + n <= fineness; ++n) {
      const double a = double(m) / fineness, b = double(n) / fineness, c = 1 - a - b;
      const gp_XY at = face.parameters[i] * a + face.parameters[j] * b + face.parameters[k] * c;
      visit(a, b, c,
            offset_of_surface(surface, at, a * face.places[i] + b * face.places[j] + c * face.places[k]));
    }
  }
}

/// Splits edges within one face.
class Refinement {
 public:
  Refinement(const BRepAdaptor_Surface& surface, double deflection, FaceTriangles& face)
      : surface_(surface), deflection_(deflection), face_(face) {
    constexpr std::size_t most_of_one = 20;
    most_ = most_of_one * face.triangles.size();
    for (std::uint32_t t = 0; t < face.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) join(face.triangles[t][k], face.triangles[t][(k + 1) % 3], t);
  }

  void run() {
    std::vector<std::uint32_t> left;
    for (auto t = static_cast<std::uint32_t>(face_.triangles.size()); t-- > 0;) left.push_back(t);
    while (!left.empty() && face_.triangles.size() + 2 <= most_) {
      const std::uint32_t t = left.back();
      left.pop_back();
      if (beyond_corners(face_.triangles[t]) <= deflection_) continue;
      const int edge = edge_to_split(face_.triangles[t]);
      if (edge >= 0) split(face_.triangles[t][edge], face_.triangles[t][(edge + 1) % 3], left);
    }
  }

 private:
  static constexpr std::uint32_t none = 0xFFFFFFFF;
  using Sides = std::array<std::uint32_t, 2>;  // the triangles at an edge

  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32U | std::max(a, b);
  }
  void join(std::uint32_t a, std::uint32_t b, std::uint32_t triangle) {
    Sides& sides = edges_.try_emplace(key(a, b), Sides{none, none}).first->second;
    (sides[0] == none ? sides[0] : sides[1]) = triangle;
  }

  /// Distance of the surface from the triangle, minus that of its corners.
  double beyond_corners(const Corners& corners) const {
    std::array<double, 3> off{};
    for (int k = 0; k < 3; ++k)
      off[k] = offset_of_surface(surface_, face_.parameters[corners[k]], face_.places[corners[k]]).norm();
    double most = 0;
    for_each_offset(surface_, face_, corners, [&](double a, double b, double c, const Vector<3>& offset) {
      most = std::max(most, offset.norm() - (a * off[0] + b * off[1] + c * off[2]));
    });
    return most;
  }

  /// The edge whose middle is farthest from the surface, or the longest if none is off; -1 if none is left.
  int edge_to_split(const Corners& corners) const {
    int farthest = -1, longest = -1;
    double off = 0.25 * deflection_, length = deflection_;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      if (edges_.at(key(a, b))[1] == none) continue;
      const double long_ = (face_.places[a] - face_.places[b]).norm();
      if (!(long_ > deflection_)) continue;
      if (long_ > length) longest = k, length = long_;
      const Vector<3> middle = 0.5 * (face_.places[a] + face_.places[b]);
      const double offset =
          offset_of_surface(surface_, (face_.parameters[a] + face_.parameters[b]) * 0.5, middle).norm();
      if (offset > off) farthest = k, off = offset;
    }
    return farthest >= 0 ? farthest : longest;
  }

  void split(std::uint32_t a, std::uint32_t b, std::vector<std::uint32_t>& left) {
    const auto middle = static_cast<std::uint32_t>(face_.places.size());
    const gp_XY at = (face_.parameters[a] + face_.parameters[b]) * 0.5;
    face_.parameters.push_back(at);
    face_.places.push_back(vector_of(surface_.Value(at.X(), at.Y())));
    const Sides sides = edges_.at(key(a, b));
    edges_.erase(key(a, b));
    for (const std::uint32_t t : sides) {
      Corners& old = face_.triangles[t];
      const auto first = std::ranges::find_if(old, [&](std::uint32_t c) { return c != a && c != b; });
      std::ranges::rotate(old, first);  // the corner that is at neither end first
      const auto [apex, from, to] = old;
      const auto added = static_cast<std::uint32_t>(face_.triangles.size());
      old = {apex, from, middle};
      face_.triangles.push_back({apex, middle, to});
      Sides& moved = edges_.at(key(apex, to));
      (moved[0] == t ? moved[0] : moved[1]) = added;
      join(from, middle, t);
      join(middle, to, added);
      join(apex, middle, t);
      join(apex, middle, added);
      left.push_back(added);
      left.push_back(t);
    }
  }

  const BRepAdaptor_Surface& surface_;
  double deflection_;
  FaceTriangles& face_;
  std::size_t most_ = 0;
  std::unordered_map<std::uint64_t, Sides> edges_;
};

}  // namespace

SurfaceDeviation deviation_of(const BRepAdaptor_Surface& surface, const FaceTriangles& face,
                              const Corners& corners) {
  const Vector<3>& a = face.places[corners[0]];
  const Vector<3> normal = (face.places[corners[1]] - a).cross(face.places[corners[2]] - a);
  SurfaceDeviation deviation;
  for_each_offset(surface, face, corners, [&](double, double, double, const Vector<3>& offset) {
    double& side = normal.dot(offset) > 0 ? deviation.outside : deviation.inside;
    side = std::max(side, offset.norm());
  });
  return deviation;
}

void refine(const BRepAdaptor_Surface& surface, double deflection, FaceTriangles& face) {
  Refinement(surface, deflection, face).run();
}

}  // namespace bernal::cad
