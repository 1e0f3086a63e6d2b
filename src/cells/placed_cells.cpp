#include "cells/placed_cells.hpp"

#include <algorithm>

namespace bernal {
namespace {

using Image = Cells::Image;

Image minus(const Image& a, const Image& b) {
  return {static_cast<std::int8_t>(a[0] - b[0]), static_cast<std::int8_t>(a[1] - b[1]),
          static_cast<std::int8_t>(a[2] - b[2])};
}

class Placing {
 public:
  explicit Placing(const Cells& cells)
      : cells_(cells), nodes_at_(cells.corners.size(), Cells::none), front_(cells.faces.size(), 0) {}

  PlacedCells run() {
    made_.faces_of_cell.resize(cells_.size());
    for (std::uint32_t cell = 0; cell < cells_.size(); ++cell)
      for (const Cells::Side& side : cells_.sides_of(cell)) add_side(cell, side);
    return std::move(made_);
  }

 private:
  void add_side(std::uint32_t cell, const Cells::Side& side) {
    std::vector<std::int64_t>& faces = made_.faces_of_cell[cell];
    const Image image = cells_.image_of(side);
    if (side.beyond && image == Image{}) {
      faces.push_back(-1 - static_cast<std::int64_t>(front_[side.face]));
      made_.faces[front_[side.face]].other = cell;
      return;
    }
    const auto number = static_cast<std::uint32_t>(made_.faces.size());
    PlacedCells::Face face{.face = side.face, .cell = cell, .origin = {number, {}}};
    if (side.beyond)
      face.origin = {front_[side.face], image};
    else
      front_[side.face] = number;
    for (const Cells::Corner& corner : cells_.corners_of(side.face))
      face.nodes.push_back(node(corner, image));
    if (side.beyond) std::ranges::reverse(face.nodes);
    const std::size_t count = cells_.dimension == 2 ? 1 : face.nodes.size();
    for (std::size_t k = 0; k < count; ++k)
      face.edges.push_back(edge(face.nodes[k], face.nodes[(k + 1) % face.nodes.size()]));
    faces.push_back(1 + static_cast<std::int64_t>(number));
    made_.faces.push_back(std::move(face));
  }

  std::uint32_t node(Cells::Corner corner, const Image& image) {
    for (std::size_t k = 0; k < 3; ++k)
      corner.image[k] = static_cast<std::int8_t>(corner.image[k] + image[k]);
    std::uint32_t first = nodes_at_[corner.corner], last = Cells::none;
    for (std::uint32_t n = first; n != Cells::none; n = next_node_[n]) {
      if (made_.corner_of_node[n] == corner) return n;
      last = n;
    }
    const auto number = static_cast<std::uint32_t>(made_.nodes.size());
    (last == Cells::none ? nodes_at_[corner.corner] : next_node_[last]) = number;
    if (first == Cells::none) first = number;
    next_node_.push_back(Cells::none);
    first_edge_.push_back(Cells::none);
    made_.nodes.push_back(cells_.place(corner));
    made_.corner_of_node.push_back(corner);
    made_.origin_of_node.push_back({first, minus(corner.image, made_.corner_of_node[first].image)});
    return number;
  }

  /// Edges stand in lists of their lower node; those that are images of each other in lists of the first
  /// node of their lower corner.
  std::int64_t edge(std::uint32_t from, std::uint32_t to) {
    const std::uint32_t low = std::min(from, to);
    std::uint32_t last = Cells::none;
    for (std::uint32_t e = first_edge_[low]; e != Cells::none; e = next_edge_[e]) {
      const PlacedCells::Edge& known = made_.edges[e];
      if (known.from == from && known.to == to) return 1 + static_cast<std::int64_t>(e);
      if (known.from == to && known.to == from) return -1 - static_cast<std::int64_t>(e);
      last = e;
    }
    const auto number = static_cast<std::uint32_t>(made_.edges.size());
    (last == Cells::none ? first_edge_[low] : next_edge_[last]) = number;
    next_edge_.push_back(Cells::none);
    next_image_.push_back(Cells::none);
    made_.edges.push_back({from, to, {number, {}}, false});
    find_origin(number);
    return 1 + static_cast<std::int64_t>(number);
  }

  void find_origin(std::uint32_t number) {
    PlacedCells::Edge& edge = made_.edges[number];
    const Cells::Corner a = made_.corner_of_node[edge.from], b = made_.corner_of_node[edge.to];
    const CellEdge key = cell_edge(a, b);
    if (images_at_.size() < cells_.corners.size()) images_at_.resize(cells_.corners.size(), Cells::none);
    std::uint32_t last = Cells::none;
    for (std::uint32_t e = images_at_[key.from]; e != Cells::none; e = next_image_[e]) {
      last = e;
      const PlacedCells::Edge& known = made_.edges[e];
      const Cells::Corner c = made_.corner_of_node[known.from], d = made_.corner_of_node[known.to];
      if (cell_edge(c, d) != key) continue;
      const bool same_way =
          a.corner == c.corner && b.corner == d.corner && minus(b.image, a.image) == minus(d.image, c.image);
      edge.is_backwards = !same_way;
      edge.origin = {e, minus(a.image, same_way ? c.image : d.image)};
      return;
    }
    (last == Cells::none ? images_at_[key.from] : next_image_[last]) = number;
  }

  const Cells& cells_;
  PlacedCells made_;
  std::vector<std::uint32_t> nodes_at_, next_node_;    // of corners
  std::vector<std::uint32_t> front_;                   // of the faces of cells
  std::vector<std::uint32_t> first_edge_, next_edge_;  // of nodes
  std::vector<std::uint32_t> images_at_, next_image_;  // of corners, those that are no images
};

}  // namespace

PlacedCells placed(const Cells& cells) { return Placing(cells).run(); }

}  // namespace bernal
