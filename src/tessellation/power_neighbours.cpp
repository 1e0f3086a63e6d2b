#include "tessellation/power_neighbours.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <utility>

namespace bernal {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel,
                                                CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using CellBase = CGAL::Regular_triangulation_cell_base_3<Kernel>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<VertexBase, CellBase>>;

}  // namespace

PowerNeighbours power_neighbours(std::span<const Site> sites, std::size_t asked) {
  std::vector<std::pair<Triangulation::Weighted_point, std::uint32_t>> points;
  points.reserve(sites.size());
  for (const auto& [p, weight] : sites)
    points.emplace_back(Triangulation::Weighted_point({p[0], p[1], p[2]}, weight),
                        static_cast<std::uint32_t>(points.size()));
  const Triangulation triangulation(points.begin(), points.end());

  PowerNeighbours found;
  found.hidden.assign(asked, true);
  for (const Triangulation::Vertex_handle vertex : triangulation.finite_vertex_handles())
    if (vertex->info() < asked) found.hidden[vertex->info()] = false;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  for (const auto& [cell, i, j] : triangulation.finite_edges()) {
    const std::uint32_t a = cell->vertex(i)->info(), b = cell->vertex(j)->info();
    if (a < asked || b < asked) ends.emplace_back(a, b);
  }
  found.start.assign(asked + 1, 0);
  const auto count = [&](std::uint32_t site) {
    if (site < asked) ++found.start[site];
  };
  for (const auto& [a, b] : ends) {
    count(a);
    count(b);
  }
  for (std::size_t k = 1; k <= asked; ++k) found.start[k] += found.start[k - 1];
  found.list.resize(found.start[asked]);
  const auto add = [&](std::uint32_t site, std::uint32_t other) {
    if (site < asked) found.list[--found.start[site]] = other;
  };
  for (const auto& [a, b] : ends) {
    add(a, b);
    add(b, a);
  }
  return found;
}

}  // namespace bernal
