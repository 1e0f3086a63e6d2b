#include "cells/neper_domain.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace bernal {
namespace {

/// The domain's corners, edges and faces; what of the cells is on them is numbered from 0.
struct Skeleton {
  struct Corner {
    Vector<3> place = Vector<3>::Zero();
    std::string label = {};
    std::int64_t node = -1;
  };
  struct Edge {
    std::array<std::uint32_t, 2> corners = {};
    std::string label = {};
    std::vector<std::uint32_t> edges = {};
  };
  struct Face {
    std::vector<std::uint32_t> corners = {};  ///< around it; edge k is from corner k to the next
    std::vector<std::uint32_t> edges = {};
    Cells::Wall plane = {};
    std::vector<std::uint32_t> faces = {};
  };
  std::string kind;
  std::vector<Corner> corners;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

/// The box of the domain's bounds, with the faces of cells on its walls.
Skeleton box_of(const CellFile& file, const PlacedCells& placed) {
  Skeleton made{.kind = "cube", .corners = {}, .edges = {}, .faces = {}};
  const Bounds<3> bounds = bounds_of(file.packing.domain);
  const auto label = [](std::uint32_t k, int axis) {
    return std::string{"xyz"[axis], (k >> axis & 1) != 0 ? '1' : '0'};
  };
  for (std::uint32_t k = 0; k < 8; ++k) {
    Vector<3> place;
    for (int axis = 0; axis < 3; ++axis)
      place[axis] = (k >> axis & 1) != 0 ? bounds.upper[axis] : bounds.lower[axis];
    made.corners.push_back({place, label(k, 0) + label(k, 1) + label(k, 2)});
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edge_between;
  for (std::uint32_t k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t other = k | 1u << axis;
      if (other == k) continue;
      edge_between[{k, other}] = edge_between[{other, k}] = static_cast<std::uint32_t>(made.edges.size());
      std::string name;
      for (int across = 0; across < 3; ++across)
        if (across != axis) name += label(k, across);
      made.edges.push_back({{k, other}, name});
    }
  for (int axis = 0; axis < 3; ++axis)
    for (std::uint32_t above = 0; above < 2; ++above) {
      const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, base = above << axis;
      Skeleton::Face face{.corners = {base, base | u, base | u | v, base | v}};
      for (std::size_t k = 0; k < 4; ++k)
        face.edges.push_back(edge_between.at({face.corners[k], face.corners[(k + 1) % 4]}));
      face.plane.name = label(above << axis, axis);
      face.plane.normal = Vector<3>::Unit(axis);
      face.plane.offset = above != 0 ? bounds.upper[axis] : bounds.lower[axis];
      made.faces.push_back(std::move(face));
    }
  if (std::holds_alternative<Box>(file.packing.domain))
    for (std::uint32_t f = 0; f < placed.faces.size(); ++f)
      if (const std::uint32_t wall = file.cells.faces[placed.faces[f].face].wall; wall != Cells::none)
        made.faces[wall].faces.push_back(f);
  return made;
}

/// What walls meet where: the corners of the domain are nodes of three walls, its edges those of two.
class OfWalls {
 public:
  OfWalls(const CellFile& file, const PlacedCells& placed)
      : cells_(file.cells), placed_(placed), walls_of_node_(placed.nodes.size()) {
    std::vector<std::vector<std::uint32_t>> walls_of_edge(placed.edges.size());
    std::vector<std::vector<std::uint32_t>> faces_of_wall(cells_.walls.size());
    for (std::uint32_t f = 0; f < placed.faces.size(); ++f) {
      const std::uint32_t wall = cells_.faces[placed.faces[f].face].wall;
      if (wall == Cells::none) continue;
      faces_of_wall[wall].push_back(f);
      for (const std::uint32_t node : placed.faces[f].nodes) walls_of_node_[node].insert(wall);
      for (const std::int64_t edge : placed.faces[f].edges)
        walls_of_edge[static_cast<std::size_t>(std::abs(edge) - 1)].push_back(wall);
    }
    for (std::uint32_t e = 0; e < placed.edges.size(); ++e)
      if (walls_of_edge[e].size() == 2 && walls_of_edge[e][0] != walls_of_edge[e][1])
        edges_between_[std::minmax(walls_of_edge[e][0], walls_of_edge[e][1])].push_back(e);
    add_corners();
    add_edges();
    for (std::uint32_t wall = 0; wall < cells_.walls.size(); ++wall)
      if (!faces_of_wall[wall].empty()) add_face(wall, std::move(faces_of_wall[wall]));
    made_.kind = std::holds_alternative<Box>(file.packing.domain)        ? "cube"
                 : std::holds_alternative<Cylinder>(file.packing.domain) ? "cylinder"
                                                                         : "poly";
  }

  Skeleton made() && { return std::move(made_); }

 private:
  std::string label_of(const std::set<std::uint32_t>& walls) const {
    std::string label;
    for (const std::uint32_t wall : walls) label += cells_.walls[wall].name;
    return label;
  }
  void add_corners() {
    for (std::uint32_t n = 0; n < placed_.nodes.size(); ++n) {
      if (walls_of_node_[n].size() < 3) continue;
      corner_at_[n] = static_cast<std::uint32_t>(made_.corners.size());
      made_.corners.push_back({placed_.nodes[n], label_of(walls_of_node_[n]), n});
    }
  }
  void add_edges() {
    for (const auto& [walls, edges] : edges_between_) {
      Skeleton::Edge edge{.label = label_of({walls.first, walls.second}), .edges = edges};
      std::vector<std::uint32_t> ends;
      for (const std::uint32_t e : edges)
        for (const std::uint32_t node : {placed_.edges[e].from, placed_.edges[e].to})
          if (const auto corner = corner_at_.find(node); corner != corner_at_.end())
            ends.push_back(corner->second);
      if (ends.size() < 2) continue;
      edge.corners = {ends.front(), ends.back()};
      edges_of_wall_[walls.first].push_back(static_cast<std::uint32_t>(made_.edges.size()));
      edges_of_wall_[walls.second].push_back(static_cast<std::uint32_t>(made_.edges.size()));
      made_.edges.push_back(std::move(edge));
    }
  }
  /// The edges of a wall one after the other.
  void add_face(std::uint32_t wall, std::vector<std::uint32_t> faces) {
    Skeleton::Face face{.plane = cells_.walls[wall], .faces = std::move(faces)};
    std::vector<std::uint32_t> left = edges_of_wall_[wall];
    std::uint32_t at = left.empty() ? 0 : made_.edges[left[0]].corners[0];
    while (!left.empty()) {
      const auto next = std::ranges::find_if(left, [&](std::uint32_t e) {
        return made_.edges[e].corners[0] == at || made_.edges[e].corners[1] == at;
      });
      if (next == left.end()) break;
      face.corners.push_back(at);
      face.edges.push_back(*next);
      const auto& ends = made_.edges[*next].corners;
      at = ends[0] == at ? ends[1] : ends[0];
      left.erase(next);
    }
    made_.faces.push_back(std::move(face));
  }

  const Cells& cells_;
  const PlacedCells& placed_;
  Skeleton made_;
  std::vector<std::set<std::uint32_t>> walls_of_node_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges_between_;
  std::map<std::uint32_t, std::uint32_t> corner_at_;  // of nodes
  std::map<std::uint32_t, std::vector<std::uint32_t>> edges_of_wall_;
};

void add_numbers(TextFile& out, const std::vector<std::uint32_t>& numbers) {
  out.add(numbers.size());
  for (const std::uint32_t number : numbers) out.add(" ", number + 1);
  out.add("\n");
}

}  // namespace

void write_neper_domain(const CellFile& file, const PlacedCells& placed, TextFile& out) {
  const bool repeats = file.cells.periods.maxCoeff() > 0;
  const Skeleton domain = repeats ? box_of(file, placed) : OfWalls(file, placed).made();
  out.add(" **domain\n  *general\n   ", domain.kind, "\n  *vertex\n   ", domain.corners.size(), "\n");
  for (std::size_t k = 0; k < domain.corners.size(); ++k) {
    const Skeleton::Corner& corner = domain.corners[k];
    out.add("   ", k + 1, " ", corner.place[0], " ", corner.place[1], " ", corner.place[2], " ", corner.label,
            "\n      1 ", corner.node + 1, "\n");
  }
  out.add("  *edge\n   ", domain.edges.size(), "\n");
  for (std::size_t k = 0; k < domain.edges.size(); ++k) {
    const Skeleton::Edge& edge = domain.edges[k];
    out.add("   ", k + 1, " 2 ", edge.corners[0] + 1, " ", edge.corners[1] + 1, "\n     line\n     0\n     ",
            edge.label, "\n     ");
    add_numbers(out, edge.edges);
  }
  out.add("  *face\n   ", domain.faces.size(), "\n");
  for (std::size_t k = 0; k < domain.faces.size(); ++k) {
    const Skeleton::Face& face = domain.faces[k];
    out.add("   ", k + 1, " ");
    add_numbers(out, face.corners);
    out.add("     ");
    add_numbers(out, face.edges);
    const Cells::Wall& plane = face.plane;
    out.add("     plane\n     4 ", plane.offset, " ", plane.normal[0], " ", plane.normal[1], " ",
            plane.normal[2], "\n     ", plane.name, "\n     ");
    add_numbers(out, face.faces);
  }
}

}  // namespace bernal
