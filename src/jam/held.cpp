#include "jam/held.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "core/every_dimension.hpp"
#include "near/periodic_pairs.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

/// Room beside a container, in largest diameters: no sphere meets an image of another.
constexpr double margin = 3;

template <int D>
std::vector<Hold> pairs_at(double gap, const Spheres<D>& spheres, const Vector<D>& edges) {
  std::vector<double> centers;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (int k = 0; k < D; ++k) centers.push_back(spheres.x[static_cast<std::size_t>(k)][i]);
  PeriodicPairs<D> pairs;
  pairs.find(centers.data(), spheres.r, edges, gap, 0);
  std::vector<Hold> holds;
  for (const auto& pair : pairs.pairs()) holds.push_back({pair.first, pair.second});
  return holds;
}

}  // namespace

Backbone backbone_of(int dimension, std::size_t spheres, std::span<const Hold> holds) {
  Backbone backbone{std::vector<char>(spheres, 1), spheres, 0};
  std::vector<int> held(spheres);
  for (bool loose = true; std::exchange(loose, false);) {
    std::ranges::fill(held, 0);
    backbone.holds = 0;
    for (const Hold& hold : holds) {
      const bool is_pair = hold.second != Hold::wall;
      if (!backbone.has[hold.first] || (is_pair && !backbone.has[hold.second])) continue;
      ++held[hold.first];
      if (is_pair) ++held[hold.second];
      ++backbone.holds;
    }
    for (std::size_t i = 0; i < spheres; ++i) {
      if (!backbone.has[i] || held[i] > dimension) continue;
      backbone.has[i] = 0;
      --backbone.spheres;
      loose = true;
    }
  }
  return backbone;
}

template <int D>
std::vector<Hold> contacts_at(double gap, const Spheres<D>& spheres, const Vector<D>& edges,
                              const std::vector<bool>& walls) {
  std::vector<Hold> holds = pairs_at<D>(gap, spheres, edges_around_walls<D>(edges, walls));
  for (std::size_t k = 0; k < walls.size(); ++k)
    for (std::uint32_t i = 0; i < spheres.size() && walls[k]; ++i) {
      const double x = spheres.x[k][i], reach = (1 + gap) * spheres.r[i];
      for (const double clearance : {x, edges[static_cast<int>(k)] - x})
        if (clearance < reach) holds.push_back({i, Hold::wall});
    }
  return holds;
}

std::vector<Hold> contacts_at(double gap, const Spheres<3>& spheres, const Container& container) {
  std::vector<Hold> holds = pairs_at<3>(gap, spheres, edges_around(container, std::ranges::max(spheres.r)));
  std::vector<WallPoint> points;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const double reach = (1 + gap) * spheres.r[i];
    points.clear();
    container.walls_near(spheres.center(i), reach, points);
    for (const WallPoint& point : points)
      if (point.clearance < reach) holds.push_back({i, Hold::wall});
  }
  return holds;
}

Vector<3> edges_around(const Container& container, double largest_radius) {
  const Boundary<3>& boundary = container.boundary();
  Vector<3> edges = container.bounds().size().array() + margin * 2 * largest_radius;
  for (int k = 0; k < 3; ++k)
    if (boundary.repeats(k)) edges[k] = boundary.edges[k];
  return edges;
}

std::optional<std::string> what_is_open(double gap, int dimension, std::size_t spheres, int symmetries,
                                        std::span<const Hold> contacts) {
  const Backbone backbone = backbone_of(dimension, spheres, contacts);
  if (backbone.spheres == 0)
    return fmt::format("no sphere is held by the contacts that are closed to a gap ratio of {:.2g}", gap);
  const std::ptrdiff_t needed = isostatic_number(dimension, backbone.spheres, symmetries);
  const std::ptrdiff_t open = needed - static_cast<std::ptrdiff_t>(backbone.holds);
  if (open <= 0) return {};
  return fmt::format("{} of the {} contacts that just hold {} spheres {} open at a gap ratio of {:.2g}",
                     grouped(static_cast<std::uint64_t>(open)), grouped(static_cast<std::uint64_t>(needed)),
                     grouped(backbone.spheres), open == 1 ? "is" : "are", gap);
}

#define BERNAL_INSTANTIATE(D)                                                         \
  template std::vector<Hold> contacts_at(double, const Spheres<D>&, const Vector<D>&, \
                                         const std::vector<bool>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
