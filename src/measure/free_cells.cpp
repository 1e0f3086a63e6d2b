#include "measure/free_cells.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr int block = 16;                          // cells along the edge of one task's block
constexpr double steps_per_radius = 4;             // at least
const double half_diagonal = 0.5 * std::sqrt(3.);  // of a cube of edge 1
constexpr double widening = 1 + 1e-9;              // larger than rounding

}  // namespace

FreeCells::FreeCells(const FreeSpace& space, double edge)
    : space_(space), edge_(edge), step_(std::min(edge / steps_per_cell, space.radius() / steps_per_radius)) {
  const Bounds<3> bounds = space.container().bounds();
  for (int k = 0; k < 3; ++k) count_[k] = std::max(1, static_cast<int>(std::ceil(bounds.size()[k] / edge)));
  lower_ = bounds.center() - 0.5 * edge * Vector<3>(count_[0], count_[1], count_[2]);
  collect_nodes();
  connect();
}

Vector<3> FreeCells::center_of(const Cell& c, int size) const {
  return lower_ + edge_ * (Vector<3>(c[0], c[1], c[2]) + Vector<3>::Constant(0.5 * size));
}

/// Appends the nodes of a cube of `size` cells in octree order.
void FreeCells::refine(const Cell& cell, int size, std::vector<Node>& out) const {
  for (int k = 0; k < 3; ++k)
    if (cell[k] >= count_[k]) return;
  throw_if_interrupted();
  const Vector<3> center = center_of(cell, size);
  const double r = space_.radius(), reach = widening * half_diagonal * size * edge_;
  const double clearance = space_.container().clearance_within(center, r + reach);
  const bool whole = clearance >= r + reach;
  if (whole) {
    out.push_back({{center, clearance}, cell, size, true});
  } else if (clearance < r - reach) {
    return;
  } else if (size > 1) {
    const int half = size / 2;
    for (int child = 0; child < 8; ++child)
      refine({cell[0] + (child & 1) * half, cell[1] + (child >> 1 & 1) * half, cell[2] + (child >> 2) * half},
             half, out);
  } else if (space_.is_place(clearance)) {
    out.push_back({{center, clearance}, cell, 1, false});
  } else if (const std::optional<Place> place = space_.nearest(center, reach)) {
    out.push_back({*place, cell, 1, false});
  }
}

void FreeCells::collect_nodes() {
  Cell blocks;
  for (int k = 0; k < 3; ++k) blocks[k] = (count_[k] + block - 1) / block;
  std::vector<std::vector<Node>> parts(static_cast<std::size_t>(blocks[0]) * blocks[1] * blocks[2]);
  parallel_for(parts.size(), [&](std::size_t part) {
    const int at = static_cast<int>(part);
    refine({block * (at % blocks[0]), block * (at / blocks[0] % blocks[1]),
            block * (at / (blocks[0] * blocks[1]))},
           block, parts[part]);
  });
  for (const std::vector<Node>& part : parts) nodes_.insert(nodes_.end(), part.begin(), part.end());

  node_of_cell_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2], none);
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const auto& [place, cell, size, whole] = nodes_[n];
    Cell end;
    for (int k = 0; k < 3; ++k) end[k] = std::min(cell[k] + size, count_[k]);
    for (int z = cell[2]; z < end[2]; ++z)
      for (int y = cell[1]; y < end[1]; ++y)
        for (int x = cell[0]; x < end[0]; ++x) node_of_cell_[index({x, y, z})] = n;
  }
}

std::uint32_t FreeCells::node_at(const Cell& c) const {
  for (int k = 0; k < 3; ++k)
    if (c[k] < 0 || c[k] >= count_[k]) return none;
  return node_of_cell_[index(c)];
}

/// Any point of a whole cube is a place: here the centre of the cell.
Place FreeCells::place_in(const Cell& cell, const Node& node) const {
  if (node.size == 1) return node.place;
  const Vector<3> center = center_of(cell, 1);
  return {center,
          std::max(space_.radius(), node.place.clearance - widening * (center - node.place.point).norm())};
}

template <class Visit>
void FreeCells::for_each_neighbour(const Cell& cell, Visit&& visit) const {
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Cell next = {cell[0] + x, cell[1] + y, cell[2] + z};
        const std::uint32_t n = node_at(next);
        if (n != none && next != cell) visit(next, n);
      }
}

void FreeCells::connect() {
  DisjointSets sets(nodes_.size());
  Cell c;
  for (c[2] = 0; c[2] < count_[2]; ++c[2])
    for (c[1] = 0; c[1] < count_[1]; ++c[1])
      for (c[0] = 0; c[0] < count_[0]; ++c[0]) {
        const std::uint32_t n = node_of_cell_[index(c)];
        if (n == none || !nodes_[n].whole) continue;
        for (int k = 0; k < 3; ++k) {
          Cell next = c;
          ++next[k];
          const std::uint32_t other = node_at(next);
          if (other != none && other != n && nodes_[other].whole) sets.unite(n, other);
        }
      }

  // Joins each with its neighbour of largest clearance, which connects nearly all for one chain each.
  std::vector<std::uint32_t> upward(nodes_.size(), none);
  parallel_for(nodes_.size(), [&](std::size_t n) {
    const Node& node = nodes_[n];
    if (node.whole) return;
    Place best = node.place;
    std::uint32_t towards = none;
    for_each_neighbour(node.cell, [&](const Cell& cell, std::uint32_t other) {
      const Place place = place_in(cell, nodes_[other]);
      if (!(place.clearance > best.clearance)) return;
      best = place;
      towards = other;
    });
    if (towards != none && space_.joined(node.place, best, step_, coarse_step())) upward[n] = towards;
  });
  for (std::uint32_t n = 0; n < nodes_.size(); ++n)
    if (upward[n] != none) sets.unite(n, upward[n]);

  component_ = sets.numbered();
  std::vector<std::vector<std::uint32_t>> sideways(nodes_.size());
  parallel_for(nodes_.size(), [&](std::size_t n) {
    const Node& node = nodes_[n];
    if (node.whole) return;
    for_each_neighbour(node.cell, [&](const Cell& cell, std::uint32_t other) {
      if (component_[n] == component_[other] || (other < n && !nodes_[other].whole)) return;
      if (space_.joined(node.place, place_in(cell, nodes_[other]), step_, coarse_step()))
        sideways[n].push_back(other);
    });
  });
  for (std::uint32_t n = 0; n < nodes_.size(); ++n)
    for (const std::uint32_t other : sideways[n]) sets.unite(n, other);

  component_ = sets.numbered();
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (component_[n] == deepest_.size()) deepest_.push_back(nodes_[n].place);
    Place& deepest = deepest_[component_[n]];
    if (nodes_[n].place.clearance > deepest.clearance) deepest = nodes_[n].place;
  }
}

std::optional<FreeCells::Found> FreeCells::find(const Place& place) const {
  Cell own;
  for (int k = 0; k < 3; ++k)
    own[k] = std::clamp(static_cast<int>(std::floor((place.point[k] - lower_[k]) / edge_)), 0, count_[k] - 1);
  std::vector<std::pair<Place, std::uint32_t>> near;
  const auto add = [&](const Cell& cell, std::uint32_t n) {
    near.emplace_back(place_in(cell, nodes_[n]), n);
  };
  if (const std::uint32_t n = node_at(own); n != none) {
    if (nodes_[n].whole) return Found{component_[n], true};
    add(own, n);
  }
  for_each_neighbour(own, add);
  if (near.empty()) return {};
  std::ranges::stable_sort(
      near, {}, [&](const auto& other) { return (other.first.point - place.point).squaredNorm(); });
  for (const auto& [other, n] : near)
    if (space_.joined(place, other, step_, coarse_step())) return Found{component_[n], true};
  return Found{component_[near.front().second], false};
}

}  // namespace bernal
