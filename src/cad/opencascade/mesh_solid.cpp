#include "cad/opencascade/mesh_solid.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <gp_Pln.hxx>
#include <map>
#include <utility>

#include "core/disjoint_sets.hpp"

namespace bernal::cad {
namespace {

/// Of the mesh's extent: how far corners may be off a face, and OpenCASCADE's least.
constexpr double off_plane = 1e-8, least_tolerance = 1e-7;

gp_Pnt point_of(const Vector<3>& p) { return {p[0], p[1], p[2]}; }

/// The vertices and edges of a mesh, each made once.
class Frame {
 public:
  explicit Frame(const Mesh& mesh) : mesh_(mesh), vertices_(mesh.vertices.size()) {
    Vector<3> lower = mesh.vertices.front(), upper = lower;
    for (const Vector<3>& v : mesh.vertices) {
      lower = lower.cwiseMin(v);
      upper = upper.cwiseMax(v);
    }
    tolerance_ = std::max(least_tolerance, off_plane * (upper - lower).norm());
  }

  double tolerance() const { return tolerance_; }

  TopoDS_Wire wire(const std::vector<std::uint32_t>& loop) {
    TopoDS_Wire wire;
    builder_.MakeWire(wire);
    for (std::size_t k = 0; k < loop.size(); ++k)
      builder_.Add(wire, edge(loop[k], loop[(k + 1) % loop.size()]));
    wire.Closed(true);
    return wire;
  }

  /// Whether every edge has been passed once in either direction.
  bool is_closed() const {
    return std::ranges::all_of(edges_,
                               [](const auto& edge) { return edge.second.up == 1 && edge.second.down == 1; });
  }

 private:
  struct Shared {
    TopoDS_Edge edge;
    int up = 0, down = 0;
  };

  TopoDS_Vertex vertex(std::uint32_t corner) {
    TopoDS_Vertex& made = vertices_[corner];
    if (made.IsNull()) builder_.MakeVertex(made, point_of(mesh_.vertices[corner]), tolerance_);
    return made;
  }

  TopoDS_Shape edge(std::uint32_t from, std::uint32_t to) {
    Shared& shared = edges_[std::minmax(from, to)];
    if (shared.edge.IsNull()) {
      const auto [low, high] = std::minmax(from, to);
      shared.edge = BRepBuilderAPI_MakeEdge(vertex(low), vertex(high)).Edge();
      builder_.UpdateEdge(shared.edge, tolerance_);
    }
    ++(from < to ? shared.up : shared.down);
    return from < to ? TopoDS_Shape(shared.edge) : shared.edge.Reversed();
  }

  const Mesh& mesh_;
  const BRep_Builder builder_ = {};
  double tolerance_;
  std::vector<TopoDS_Vertex> vertices_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Shared> edges_;
};

/// The plane of a loop, whose normal has it counter-clockwise.
gp_Pln plane_of(const Mesh& mesh, const std::vector<std::uint32_t>& loop) {
  const Vector<3>& first = mesh.vertices[loop.front()];
  Vector<3> area = Vector<3>::Zero();
  for (std::size_t k = 1; k + 1 < loop.size(); ++k)
    area += (mesh.vertices[loop[k]] - first).cross(mesh.vertices[loop[k + 1]] - first);
  return {point_of(first), gp_Dir(area[0], area[1], area[2])};
}

}  // namespace

TopoDS_Shape solid_of_mesh(const Mesh& mesh,
                           const std::vector<std::vector<std::vector<std::uint32_t>>>& faces) {
  Frame frame(mesh);
  DisjointSets together(mesh.vertices.size());  // what hangs together is one shell
  std::vector<TopoDS_Face> made;
  for (const auto& loops : faces) {
    BRepBuilderAPI_MakeFace face(plane_of(mesh, loops.front()), frame.wire(loops.front()), false);
    for (std::size_t k = 1; k < loops.size(); ++k) face.Add(frame.wire(loops[k]));
    if (!face.IsDone()) return {};
    made.push_back(face.Face());
    for (const auto& loop : loops)
      for (const std::uint32_t corner : loop) together.unite(loops.front().front(), corner);
  }
  if (!frame.is_closed()) return {};
  const BRep_Builder builder;
  std::map<std::uint32_t, TopoDS_Shell> shells;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    TopoDS_Shell& shell = shells[together.find(faces[k].front().front())];
    if (shell.IsNull()) builder.MakeShell(shell);
    builder.Add(shell, made[k]);
  }
  BRepBuilderAPI_MakeSolid solid;
  for (auto& [least, shell] : shells) {
    shell.Closed(true);
    solid.Add(shell);
  }
  return solid.Solid();
}

}  // namespace bernal::cad
