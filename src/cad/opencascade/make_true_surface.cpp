#include "cad/opencascade/make_true_surface.hpp"

#include <BRep_Tool.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <limits>

#include "kernels/closest_point.hpp"

namespace bernal::cad {
namespace {

using opencascade::handle;
using Corners = FaceTriangles::Corners;

double largest_tolerance(const TopoDS_Face& face) {
  double largest = 0;
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Edge(edge.Current())));
  for (TopExp_Explorer vertex(face, TopAbs_VERTEX); vertex.More(); vertex.Next())
    largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Vertex(vertex.Current())));
  return largest;
}

ParameterBox box_of(const FaceTriangles& triangles) {
  const gp_XY& first = triangles.parameters.front();
  ParameterBox box{{first.X(), first.Y()}, {first.X(), first.Y()}};
  for (const gp_XY& p : triangles.parameters)
    for (int k = 0; k < 2; ++k) {
      box.lower[k] = std::min(box.lower[k], p.Coord(k + 1));
      box.upper[k] = std::max(box.upper[k], p.Coord(k + 1));
    }
  return box;
}

/// The triangles of a face, each of which ends at its edges where it is at the rim.
class Cover {
 public:
  Cover(const FaceTriangles& triangles, const Boundary& boundary, FacePatches& patches,
        std::uint32_t first_flat)
      : triangles_(triangles), boundary_(boundary), patches_(patches), first_flat_(first_flat) {
    for (std::uint32_t t = 0; t < triangles.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Corners& corners = triangles.triangles[t];
        edges_.push_back({ascending(corners[k], corners[(k + 1) % 3]), t});
      }
    std::ranges::sort(edges_);
  }

  /// Whether what the triangles cover ends at the edges of the face: then it is all of the face.
  bool is_whole() const {
    std::size_t ends = 0;
    for (auto edge = edges_.begin(); edge != edges_.end();) {
      const auto next =
          std::ranges::find_if(edge, edges_.end(), [&](const auto& e) { return e.first != edge->first; });
      if ((next - edge) % 2 == 1) {
        const auto& [a, b] = edge->first;
        if (!boundary_.contains({a, b}) && !boundary_.contains({b, a})) return false;
        ++ends;
      }
      edge = next;
    }
    return ends == boundary_.size();
  }

  void append() {
    for (std::uint32_t t = 0; t < triangles_.triangles.size(); ++t)
      append(triangles_.triangles[t], first_flat_ + flat_of(t));
  }

 private:
  bool has_area(const Corners& t) const {
    const auto& places = triangles_.places;
    return places[t[0]] != places[t[1]] && places[t[1]] != places[t[2]] && places[t[2]] != places[t[0]];
  }

  /// At a pole a triangle of parameters stands over one edge in space. It belongs to the triangle at that
  /// edge that is nearer to its middle.
  std::uint32_t flat_of(std::uint32_t t) {
    const Corners& corners = triangles_.triangles[t];
    if (has_area(corners)) return t;
    const Parameters middle = middle_of(corners);
    const Vector<3> p = patches_.point_at(middle);
    std::uint32_t nearest = t;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k)
      for (const auto& [edge, other] :
           std::ranges::equal_range(edges_, ascending(corners[k], corners[(k + 1) % 3]), {},
                                    &std::pair<NodePair, std::uint32_t>::first)) {
        if (!has_area(triangles_.triangles[other])) continue;
        const auto& [a, b, c] = triangles_.triangles[other];
        const double distance =
            PreparedTriangle(triangles_.places[a], triangles_.places[b], triangles_.places[c])
                .offset(p)
                .norm();
        if (distance < least) least = distance, nearest = other;
      }
    return nearest;
  }

  Parameters middle_of(const Corners& corners) const {
    Parameters middle{};
    for (const std::uint32_t node : corners)
      for (int x = 0; x < 2; ++x) middle[x] += at(node)[x] / 3;
    return middle;
  }

  Parameters at(std::uint32_t node) const {
    return {triangles_.parameters[node].X(), triangles_.parameters[node].Y()};
  }

  /// A triangle without lines of the face is a piece. Else it is a cone over its sides, which covers whatever
  /// they wind around: from the corner opposite the only side that bends, or from the middle.
  void append(const Corners& corners, std::uint32_t flat) {
    std::vector<Parameters> around;
    std::vector<double> off;
    int bent = 0;
    Parameters apex{};
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      const auto ahead = boundary_.find({a, b}), back = boundary_.find({b, a});
      around.push_back(at(a));
      if (ahead == boundary_.end() && back == boundary_.end()) {
        off.push_back(0);
        continue;
      }
      const bool turned = ahead == boundary_.end();
      const BoundaryLine& line = (turned ? back : ahead)->second;
      append_edge(line, flat);
      const auto n = line.off.size();
      for (std::size_t i = 0; i < n; ++i) {
        if (i > 0) around.push_back(line.points[turned ? n - i : i]);
        off.push_back(line.off[turned ? n - 1 - i : i]);
      }
      if (n > 1) ++bent, apex = at(corners[(k + 2) % 3]);
    }
    if (bent == 0) {
      patches_.append({at(corners[0]), at(corners[1]), at(corners[2])}, flat, *std::ranges::max_element(off));
      return;
    }
    if (bent > 1) apex = middle_of(corners);
    for (std::size_t i = 0; i < around.size(); ++i) {
      const Parameters &p = around[i], &q = around[(i + 1) % around.size()];
      if (p != apex && q != apex) patches_.append({apex, p, q}, flat, off[i]);
    }
  }

  /// What is between the edge on this face and the edge itself, and between that and its corners.
  void append_edge(const BoundaryLine& line, std::uint32_t flat) {
    for (std::size_t i = 0; i < line.off.size(); ++i)
      patches_.append({line.points[i], line.points[i + 1], line.points[i + 1]}, flat,
                      line.off[i] + line.tolerance);
    const auto corner = [&](const Parameters& p, double tolerance) {
      if (tolerance > 0) patches_.append({p, p, p}, flat, 2 * (tolerance + line.tolerance));
    };
    corner(line.points.front(), line.tolerance_from);
    corner(line.points.back(), line.tolerance_to);
  }

  const FaceTriangles& triangles_;
  const Boundary& boundary_;
  FacePatches& patches_;
  std::uint32_t first_flat_;
  std::vector<std::pair<NodePair, std::uint32_t>> edges_;  ///< each with a triangle, sorted
};

}  // namespace

void append_face(const TopoDS_Face& face, const handle<Poly_Triangulation>& triangulation,
                 const TopLoc_Location& location, const FaceTriangles& triangles, double fine,
                 TrueSurface& surface) {
  TrueSurface::Face made{static_cast<std::uint32_t>(surface.faces.size() + 1), "", largest_tolerance(face)};
  const auto first_flat = static_cast<std::uint32_t>(surface.flats.size());
  const auto index = static_cast<std::uint32_t>(surface.faces.size());
  for (const Corners& t : triangles.triangles)
    surface.flats.push_back(
        {{triangles.places[t[0]], triangles.places[t[1]], triangles.places[t[2]]}, index});
  const auto at_node = [&](std::uint32_t node) {
    return Parameters{triangles.parameters[node].X(), triangles.parameters[node].Y()};
  };
  try {
    FacePatches patches(BRep_Tool::Surface(face), box_of(triangles), surface);
    made.kind = patches.kind();
    made.without_bound = patches.without_bound();
    if (made.without_bound.empty()) {
      Boundary boundary = boundary_of(face, triangulation, location, patches, fine);
      for (const auto& [from, to, node] : triangles.cuts) cut(boundary, {from, to}, node, at_node(node));
      for (const auto& [nodes, line] : boundary) made.tolerance = std::max(made.tolerance, line.tolerance);
      Cover cover(triangles, boundary, patches, first_flat);
      if (cover.is_whole())
        cover.append();
      else
        made.without_bound = "its triangles do not end at its edges";
    }
  } catch (const Standard_Failure& failure) {
    made.without_bound = failure.GetMessageString();
  }
  surface.faces.push_back(std::move(made));
}

}  // namespace bernal::cad
