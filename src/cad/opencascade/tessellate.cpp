#include "cad/opencascade/tessellate.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Line.hxx>
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

#include "cad/opencascade/face_triangles.hpp"
#include "cad/opencascade/make_true_surface.hpp"
#include "cad/opencascade/refine_evenly.hpp"

namespace bernal::cad {
namespace {

/// Between neighbouring facets on a surface that curves strongly within the deflection.
constexpr double angular_deflection = 0.5;

/// The mesher meets the deflection on edges only approximately, and leaves slivers fifty times the deflection
/// off on twisted ruled surfaces. Faces are refined, edges are not: if more than the deflection remains, the
/// mesher is run again with a smaller one, up to this often.
constexpr int attempts = 3;

/// Where formulas come with the triangles, the mesher makes those that edges need, over deflections.
constexpr double coarse_interior = 1e4;
/// How far what is between two nodes may be off, over deflections.
constexpr double most_bend = 1.05;

/// The triangulation of one face, with nodes numbered through all faces of the shape.
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

  /// The first node equal to this one.
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
  TopTools_IndexedMapOfShape edges_, vertices_;  // identified regardless of their orientation
  std::vector<std::vector<std::uint32_t>> along_edge_;
  std::vector<std::uint32_t> at_vertex_;
};

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
  TrueSurface surface = {};
  double off = 0;  ///< as measured: the surface from the triangles
};

/// What is wanted of a tessellation.
struct Wanted {
  double deflection, of_edges;
  bool with_surface;
  double fine;
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

/// The triangles of a patch with the face's orientation.
FaceTriangles triangles_of(const FacePatch& patch, const std::vector<Vector<3>>& place, Stitcher& stitcher) {
  FaceTriangles face;
  for (int k = 1; k <= patch.triangulation->NbNodes(); ++k) {
    face.places.push_back(place[stitcher.root(patch.first + std::uint32_t(k) - 1)]);
    face.parameters.push_back(patch.triangulation->UVNode(k).XY());
  }
  for (int i = 1; i <= patch.triangulation->NbTriangles(); ++i) {
    std::array<int, 3> corner{};
    patch.triangulation->Triangle(i).Get(corner[0], corner[1], corner[2]);
    if (patch.face.Orientation() == TopAbs_REVERSED) std::swap(corner[1], corner[2]);
    auto& corners = face.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) corners[k] = std::uint32_t(corner[k]) - 1;
  }
  return face;
}

/// The edges that are a point in space, and a straight line in the plane of parameters, by their nodes.
std::vector<NodePair> poles_of(const FacePatch& patch) {
  std::vector<NodePair> poles;
  for (TopExp_Explorer at(patch.face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(at.Current());
    if (!BRep_Tool::Degenerated(edge)) continue;
    const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, patch.triangulation, patch.location);
    double first = 0, last = 0;
    const auto curve = BRep_Tool::CurveOnSurface(edge, patch.face, first, last);
    if (polygon.IsNull() || opencascade::handle<Geom2d_Line>::DownCast(curve).IsNull()) continue;
    for (int k = 1; k < polygon->NbNodes(); ++k)
      poles.push_back({std::uint32_t(polygon->Node(k)) - 1, std::uint32_t(polygon->Node(k + 1)) - 1});
  }
  return poles;
}

/// Whether all faces are parts of planes, cylinders, cones, balls and tori. On others triangles may fold
/// where few become many.
bool is_elementary(const TopoDS_Shape& shape) {
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    if (BRepAdaptor_Surface(TopoDS::Face(face.Current()), false).GetType() > GeomAbs_Torus) return false;
  return true;
}

void mesh(const TopoDS_Shape& shape, const Wanted& wanted) {
  IMeshTools_Parameters parameters;
  parameters.Angle = angular_deflection;
  parameters.Relative = false;
  parameters.Deflection = wanted.of_edges;
  if (wanted.with_surface && is_elementary(shape)) {  // the few nodes inside of faces that it needs
    parameters.DeflectionInterior = coarse_interior * wanted.deflection;
    parameters.AngleInterior = 1;
  }
  const BRepMesh_IncrementalMesh done(shape, parameters);
}

/// How far faces are off at most where their edges have the same parameters, in the middle between two nodes
/// of an edge.
double off_at_edges(const TopoDS_Shape& shape) {
  double most = 0;
  std::size_t untriangulated = 0;
  for (const FacePatch& patch : patches_of(shape, untriangulated)) {
    const BRepAdaptor_Surface surface(patch.face, false);
    const auto place_at = [&](const gp_XY& at) { return vector_of(surface.Value(at.X(), at.Y())); };
    for (TopExp_Explorer edge(patch.face, TopAbs_EDGE); edge.More(); edge.Next()) {
      const auto polygon = BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Current()),
                                                             patch.triangulation, patch.location);
      if (polygon.IsNull()) continue;
      for (int k = 1; k < polygon->NbNodes(); ++k) {
        const gp_XY from = patch.triangulation->UVNode(polygon->Node(k)).XY(),
                    to = patch.triangulation->UVNode(polygon->Node(k + 1)).XY();
        most = std::max(most, (place_at((from + to) * 0.5) - 0.5 * (place_at(from) + place_at(to))).norm());
      }
    }
  }
  return most;
}

/// Of what the mesher has made.
Attempt tessellate(const TopoDS_Shape& shape, const Wanted& wanted) {
  const double deflection = wanted.deflection;
  Attempt result;
  auto& [soup, made, true_surface, off] = result;
  const std::vector<FacePatch> patches = patches_of(shape, made.untriangulated);
  std::vector<Vector<3>> place;
  for (const FacePatch& patch : patches)
    for (int k = 1; k <= patch.triangulation->NbNodes(); ++k)
      place.push_back(vector_of(patch.triangulation->Node(k).Transformed(patch.location.Transformation())));

  Stitcher stitcher(patches);
  constexpr std::uint32_t unnumbered = 0xFFFFFFFF;
  std::vector<std::uint32_t> number(place.size(), unnumbered);
  const auto add = [&](const Vector<3>& p) {
    soup.points.push_back(p);
    return static_cast<std::uint32_t>(soup.points.size() - 1);
  };
  for (const FacePatch& patch : patches) {
    const BRepAdaptor_Surface surface(patch.face, false);
    const std::size_t before = soup.polygons.size();
    FaceTriangles face = triangles_of(patch, place, stitcher);
    if (wanted.with_surface) {
      off = std::max(off, refine_evenly(surface, poles_of(patch), most_bend * deflection, face));
      append_face(patch.face, patch.triangulation, patch.location, face, wanted.fine, true_surface);
    } else {
      refine(surface, deflection, face);
    }
    const auto shared = static_cast<std::uint32_t>(patch.triangulation->NbNodes());
    std::vector<std::uint32_t> own(face.places.size() - shared,
                                   unnumbered);  // for the nodes that refining added
    for (const FaceTriangles::Corners& corners : face.triangles) {
      std::array<std::uint32_t, 3> node = corners;
      for (std::uint32_t& n : node)
        if (const auto pole = face.at_pole.find(n); pole != face.at_pole.end()) n = pole->second;
      const std::array<std::uint32_t, 3> local = node;
      for (std::uint32_t& n : node)
        if (n < shared)
          n = stitcher.root(patch.first + n);
        else
          n += static_cast<std::uint32_t>(place.size());
      if (node[0] == node[1] || node[1] == node[2] || node[2] == node[0]) continue;
      std::vector<std::uint32_t>& polygon = soup.polygons.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& point = local[k] < shared ? number[node[k]] : own[local[k] - shared];
        if (point == unnumbered) point = add(face.places[local[k]]);
        polygon.push_back(point);
      }
      if (wanted.with_surface) continue;  // more than that is known of it
      const SurfaceDeviation deviation = deviation_of(surface, face, corners);
      made.deviation.outside = std::max(made.deviation.outside, deviation.outside);
      made.deviation.inside = std::max(made.deviation.inside, deviation.inside);
    }
    made.without_area += soup.polygons.size() == before;
  }
  if (signed_volume(soup) < 0) std::swap(made.deviation.outside, made.deviation.inside);
  if (!wanted.with_surface) off = std::max(made.deviation.outside, made.deviation.inside);
  return result;
}

void append(TrueSurface& surface, TrueSurface&& more) {
  const auto patches = static_cast<std::uint32_t>(surface.patches.size()),
             flats = static_cast<std::uint32_t>(surface.flats.size()),
             faces = static_cast<std::uint32_t>(surface.faces.size());
  for (TrueSurface::Piece& piece : more.pieces) piece.patch += patches, piece.flat += flats;
  for (TrueSurface::Flat& flat : more.flats) flat.face += faces;
  for (TrueSurface::Face& face : more.faces) face.number += faces;
  const auto move_all = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  move_all(surface.patches, more.patches);
  move_all(surface.pieces, more.pieces);
  move_all(surface.flats, more.flats);
  move_all(surface.faces, more.faces);
}

}  // namespace

Tessellated append_tessellation(const TopoDS_Shape& shape, double deflection, PolygonSoup& soup,
                                TrueSurface* surface, double fine) {
  double finer = deflection;
  Attempt best;
  if (surface) {  // inner edges are split as often as it takes: only those of faces need another attempt
    for (int k = 0;; ++k) {
      mesh(shape, {deflection, finer, true, fine});
      const double off = off_at_edges(shape), most = most_bend * deflection;
      if (off <= most || k == attempts) break;
      finer *= std::clamp(0.9 * most / off, 0.3, 0.9);
    }
    best = tessellate(shape, {deflection, finer, true, fine});
  } else {
    const auto attempt = [&](double wanted) {
      mesh(shape, {wanted, wanted, false, fine});
      return tessellate(shape, {wanted, wanted, false, fine});
    };
    best = attempt(deflection);
    for (int k = 0; k < attempts && best.off > deflection; ++k) {
      finer *= std::clamp(0.9 * deflection / best.off, 0.3, 0.9);
      Attempt next = attempt(finer);
      const bool better = next.off < 0.9 * best.off;
      if (next.off < best.off) best = std::move(next);
      if (!better) break;
    }
  }
  const auto first = static_cast<std::uint32_t>(soup.points.size());
  soup.points.insert(soup.points.end(), best.soup.points.begin(), best.soup.points.end());
  for (auto& polygon : best.soup.polygons) {
    for (std::uint32_t& corner : polygon) corner += first;
    soup.polygons.push_back(std::move(polygon));
  }
  if (surface) append(*surface, std::move(best.surface));
  return best.made;
}

}  // namespace bernal::cad
