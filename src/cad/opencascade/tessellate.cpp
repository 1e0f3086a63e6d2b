#include "cad/opencascade/tessellate.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <array>

namespace bernal::cad {
namespace {

/// Of two neighbouring facets on a surface that curves strongly within the deflection.
constexpr double angular_deflection = 0.5;

/// The mesher bounds the distance of edges from their curves, and of triangles from their surface only
/// nearly: where more than the deflection is measured, it is asked for less, so often.
constexpr int attempts = 3;

/// The triangulation of one face, its nodes numbered through all faces of the shape.
struct FacePatch {
  TopoDS_Face face;
  opencascade::handle<Poly_Triangulation> triangulation;
  TopLoc_Location location;
  std::uint32_t first = 0;
};

class Stitcher {
 public:
  explicit Stitcher(const std::vector<FacePatch>& patches) {
    if (!patches.empty())
      parent_.resize(patches.back().first + std::size_t(patches.back().triangulation->NbNodes()));
    for (std::size_t i = 0; i < parent_.size(); ++i) parent_[i] = static_cast<std::uint32_t>(i);
    for (const FacePatch& patch : patches)
      for (TopExp_Explorer edge(patch.face, TopAbs_EDGE); edge.More(); edge.Next())
        stitch(TopoDS::Edge(edge.Current()), patch);
  }

  /// The first of all nodes that are this one.
  std::uint32_t root(std::uint32_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }

 private:
  void unite(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  void stitch(const TopoDS_Edge& edge, const FacePatch& patch) {
    const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, patch.triangulation, patch.location);
    if (polygon.IsNull() || polygon->NbNodes() == 0) return;
    std::vector<std::uint32_t> nodes;
    for (int k = 1; k <= polygon->NbNodes(); ++k)
      nodes.push_back(patch.first + std::uint32_t(polygon->Node(k)) - 1);
    if (BRep_Tool::Degenerated(edge))  // the apex of a cone, the pole of a sphere
      for (const std::uint32_t node : nodes) unite(nodes.front(), node);

    const auto number = static_cast<std::size_t>(edges_.Add(edge));
    if (number > along_edge_.size()) {
      along_edge_.push_back(nodes);
    } else if (along_edge_[number - 1].size() == nodes.size()) {
      for (std::size_t k = 0; k < nodes.size(); ++k) unite(along_edge_[number - 1][k], nodes[k]);
    }
    end_at(TopExp::FirstVertex(edge), nodes.front());
    end_at(TopExp::LastVertex(edge), nodes.back());
  }

  void end_at(const TopoDS_Vertex& vertex, std::uint32_t node) {
    if (vertex.IsNull()) return;
    const auto number = static_cast<std::size_t>(vertices_.Add(vertex));
    if (number > at_vertex_.size()) {
      at_vertex_.push_back(node);
    } else {
      unite(at_vertex_[number - 1], node);
    }
  }

  std::vector<std::uint32_t> parent_;
  TopTools_IndexedMapOfShape edges_, vertices_;  // the same whatever their orientation
  std::vector<std::vector<std::uint32_t>> along_edge_;
  std::vector<std::uint32_t> at_vertex_;
};

Vector<3> vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// The parameters nearest to p, in closed form; false where the surface has none.
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

/// From p to the surface's point nearest to it, in closed form or by Gauss-Newton from parameters nearby. Any
/// point of the surface bounds the distance, so the nearest of the iterates is taken.
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

/// How far the surface lies from fifteen points of a triangle with these parameters at its corners: the
/// middles of its edges are among them, where a bulge is highest.
void measure(const BRepAdaptor_Surface& surface, const std::array<gp_Pnt2d, 3>& parameters,
             const std::array<Vector<3>, 3>& corners, SurfaceDeviation& deviation) {
  constexpr int fineness = 4;
  const Vector<3> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  for (int i = 0; i <= fineness; ++i) {
    for (int j = 0; i + j <= fineness; ++j) {
      const double a = double(i) / fineness, b = double(j) / fineness, c = 1 - a - b;
      const gp_XY at = parameters[0].XY() * a + parameters[1].XY() * b + parameters[2].XY() * c;
      const Vector<3> offset =
          offset_of_surface(surface, at, a * corners[0] + b * corners[1] + c * corners[2]);
      double& side = normal.dot(offset) > 0 ? deviation.outside : deviation.inside;
      side = std::max(side, offset.norm());
    }
  }
}

double signed_volume(const PolygonSoup& soup) {
  if (soup.points.empty()) return 0;
  double six_fold = 0;
  const Vector<3> origin = soup.points.front();
  for (const auto& t : soup.polygons) {
    const Vector<3> a = soup.points[t[0]] - origin, b = soup.points[t[1]] - origin;
    six_fold += a.cross(b).dot(soup.points[t[2]] - origin);
  }
  return six_fold / 6;
}

struct Attempt {
  PolygonSoup soup;
  Tessellated made;
};

std::vector<FacePatch> patches_of(const TopoDS_Shape& shape, std::size_t& untriangulated) {
  std::vector<FacePatch> patches;
  std::uint32_t nodes = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    FacePatch patch{TopoDS::Face(face.Current()), {}, {}, nodes};
    patch.triangulation = BRep_Tool::Triangulation(patch.face, patch.location);
    if (patch.triangulation.IsNull() || !patch.triangulation->HasUVNodes()) {
      ++untriangulated;
      continue;
    }
    nodes += std::uint32_t(patch.triangulation->NbNodes());
    patches.push_back(std::move(patch));
  }
  return patches;
}

Attempt tessellate(const TopoDS_Shape& shape, double deflection) {
  IMeshTools_Parameters parameters;
  parameters.Deflection = deflection;
  parameters.Angle = angular_deflection;
  parameters.Relative = false;
  const BRepMesh_IncrementalMesh done(shape, parameters);

  Attempt result;
  auto& [soup, made] = result;
  const std::vector<FacePatch> patches = patches_of(shape, made.untriangulated);
  std::vector<Vector<3>> place;
  for (const FacePatch& patch : patches)
    for (int k = 1; k <= patch.triangulation->NbNodes(); ++k)
      place.push_back(vector_of(patch.triangulation->Node(k).Transformed(patch.location.Transformation())));

  Stitcher stitcher(patches);
  constexpr std::uint32_t unnumbered = 0xFFFFFFFF;
  std::vector<std::uint32_t> number(place.size(), unnumbered);
  for (const FacePatch& patch : patches) {
    const BRepAdaptor_Surface surface(patch.face, false);
    const std::size_t before = soup.polygons.size();
    for (int i = 1; i <= patch.triangulation->NbTriangles(); ++i) {
      std::array<int, 3> corner{};
      patch.triangulation->Triangle(i).Get(corner[0], corner[1], corner[2]);
      if (patch.face.Orientation() == TopAbs_REVERSED) std::swap(corner[1], corner[2]);
      std::array<std::uint32_t, 3> root{};
      for (int k = 0; k < 3; ++k) root[k] = stitcher.root(patch.first + std::uint32_t(corner[k]) - 1);
      if (root[0] == root[1] || root[1] == root[2] || root[2] == root[0]) continue;

      std::array<Vector<3>, 3> corners;
      std::array<gp_Pnt2d, 3> at;
      std::vector<std::uint32_t>& polygon = soup.polygons.emplace_back();
      for (int k = 0; k < 3; ++k) {
        if (number[root[k]] == unnumbered) {
          number[root[k]] = static_cast<std::uint32_t>(soup.points.size());
          soup.points.push_back(place[root[k]]);
        }
        polygon.push_back(number[root[k]]);
        corners[k] = place[root[k]];
        at[k] = patch.triangulation->UVNode(corner[k]);
      }
      measure(surface, at, corners, made.deviation);
    }
    made.without_area += soup.polygons.size() == before;
  }
  if (signed_volume(soup) < 0) std::swap(made.deviation.outside, made.deviation.inside);
  return result;
}

double worst(const Attempt& attempt) {
  return std::max(attempt.made.deviation.outside, attempt.made.deviation.inside);
}

}  // namespace

Tessellated append_tessellation(const TopoDS_Shape& shape, double deflection, PolygonSoup& soup) {
  Attempt best = tessellate(shape, deflection);
  double finer = deflection;
  for (int k = 0; k < attempts && worst(best) > deflection; ++k) {
    finer *= std::clamp(0.9 * deflection / worst(best), 0.3, 0.9);
    Attempt next = tessellate(shape, finer);
    const bool better = worst(next) < 0.9 * worst(best);
    if (worst(next) < worst(best)) best = std::move(next);
    if (!better) break;
  }
  const auto first = static_cast<std::uint32_t>(soup.points.size());
  soup.points.insert(soup.points.end(), best.soup.points.begin(), best.soup.points.end());
  for (auto& polygon : best.soup.polygons) {
    for (std::uint32_t& corner : polygon) corner += first;
    soup.polygons.push_back(std::move(polygon));
  }
  return best.made;
}

}  // namespace bernal::cad
