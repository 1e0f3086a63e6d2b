#include "cad/opencascade/sewing.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <span>

namespace bernal::cad {
namespace {

using Faces = std::span<const TopoDS_Shape>;

/// An edge is identified by its middle.
std::vector<gp_Pnt> middles_of_edges(const TopoDS_Shape& face) {
  std::vector<gp_Pnt> middles;
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
    const TopoDS_Edge& one = TopoDS::Edge(edge.Current());
    if (BRep_Tool::Degenerated(one)) continue;
    const BRepAdaptor_Curve curve(one);
    middles.push_back(curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter())));
  }
  return middles;
}

/// The faces in their order, split where every edge since the last split has occurred twice; empty if the
/// last part does not close.
std::vector<Faces> parts_in_order(Faces faces, double tolerance) {
  constexpr std::size_t most_faces = 5000;  // each searches all open edges
  if (faces.size() > most_faces) return {};
  std::vector<Faces> parts;
  std::vector<gp_Pnt> open;
  std::size_t first = 0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    for (const gp_Pnt& middle : middles_of_edges(faces[k])) {
      const auto same = [&](const gp_Pnt& p) { return p.Distance(middle) <= tolerance; };
      const auto other = std::ranges::find_if(open, same);
      if (other == open.end()) {
        open.push_back(middle);
      } else {
        *other = open.back();
        open.pop_back();
      }
    }
    if (!open.empty()) continue;
    parts.push_back(faces.subspan(first, k + 1 - first));
    first = k + 1;
  }
  return open.empty() ? parts : std::vector<Faces>{};
}

void sew_part(Faces faces, double diagonal, Sewn& sewn) {
  TopoDS_Shape best;
  int best_free = 0;
  double best_tolerance = 0;
  for (const double tolerance : {1e-7 * diagonal, 1e-6 * diagonal, 1e-5 * diagonal, 1e-4 * diagonal}) {
    BRepBuilderAPI_Sewing sewing(tolerance);
    for (const TopoDS_Shape& face : faces) sewing.Add(face);
    sewing.Perform();
    if (sewing.SewedShape().IsNull()) continue;
    if (best.IsNull() || sewing.NbFreeEdges() < best_free) {
      best = sewing.SewedShape();
      best_free = sewing.NbFreeEdges();
      best_tolerance = tolerance;
    }
    if (best_free == 0) break;
  }
  if (best.IsNull()) return;
  sewn.free_edges += best_free;
  sewn.tolerance = std::max(sewn.tolerance, best_tolerance);
  for (TopExp_Explorer shell(best, TopAbs_SHELL); shell.More(); shell.Next())
    sewn.shells.push_back(shell.Current());
  for (TopExp_Explorer face(best, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
    sewn.shells.push_back(face.Current());
}

}  // namespace

Sewn sew(const std::vector<TopoDS_Shape>& faces, double diagonal) {
  if (const std::vector<Faces> parts = parts_in_order(faces, 1e-5 * diagonal); parts.size() > 1) {
    Sewn apart;
    apart.parts = parts.size();
    for (const Faces& part : parts) sew_part(part, diagonal, apart);
    if (apart.free_edges == 0) return apart;
  }
  Sewn together;
  sew_part(faces, diagonal, together);
  return together;
}

}  // namespace bernal::cad
