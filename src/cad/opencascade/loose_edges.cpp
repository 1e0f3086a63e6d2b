#include "cad/opencascade/loose_edges.hpp"

#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>

#include <fmt/format.h>

#include "cad/opencascade/face_patches.hpp"

namespace bernal::cad {
namespace {

std::string place_in_words(const gp_Pnt& p) {
  return fmt::format("{:.4g}, {:.4g}, {:.4g}", p.X(), p.Y(), p.Z());
}

}  // namespace

std::string known_too_loosely(const TopoDS_Shape& shape, double smallest_radius, std::string_view unit) {
  std::string where;
  double largest = 0;
  std::size_t number = 0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    ++number;
    const auto note = [&](double tolerance, const auto& what) {
      if (tolerance <= largest) return;
      largest = tolerance;
      where = fmt::format("face {} ({}) has {}", number,
                          kind_of(BRep_Tool::Surface(TopoDS::Face(at.Current()))), what());
    };
    for (TopExp_Explorer edge(at.Current(), TopAbs_EDGE); edge.More(); edge.Next())
      note(BRep_Tool::Tolerance(TopoDS::Edge(edge.Current())), [&] {
        TopoDS_Vertex from, to;
        TopExp::Vertices(TopoDS::Edge(edge.Current()), from, to);
        if (from.IsNull() || to.IsNull()) return std::string("an edge");
        return fmt::format("an edge from {} to {}", place_in_words(BRep_Tool::Pnt(from)),
                           place_in_words(BRep_Tool::Pnt(to)));
      });
    for (TopExp_Explorer corner(at.Current(), TopAbs_VERTEX); corner.More(); corner.Next())
      note(BRep_Tool::Tolerance(TopoDS::Vertex(corner.Current())), [&] {
        return fmt::format("a corner at {}",
                           place_in_words(BRep_Tool::Pnt(TopoDS::Vertex(corner.Current()))));
      });
  }
  if (!(smallest_radius > 0) || largest < smallest_radius) return {};
  return fmt::format(
      "{}, which the file knows to {:.3g}{} only, no less than the smallest sphere's radius of {:.3g}{}; "
      "export "
      "the part again with a finer tolerance, or take the key out",
      where, largest, unit, smallest_radius, unit);
}

}  // namespace bernal::cad
