#include "verify/mesh_wall.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>
#include <Eigen/Geometry>

#include "bernal/core/error.hpp"
#include "verify/least_gap.hpp"
#include "verify/segment.hpp"

namespace bernal::verify {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Largest distance of a vertex from its exact corner: two roundings of a product, and one more, or
/// underflow, for the comparison in double.
double off_by_at_most(double x) { return 0x1p-50 * std::abs(x) + 0x1p-1070; }

/// The product with a positive integer below 2^53, without rounding.
WidePoint times(double scale, const Vector<3>& p) {
  WidePoint product{scale * p, Vector<3>::Zero()};
  for (int k = 0; k < 3; ++k) product.low[k] = std::fma(scale, p[k], -product.high[k]);
  return product;
}

void check_numbers(const Mesh& mesh) {
  if (mesh.triangles.empty()) throw Error(ErrorCode::bad_mesh, "the container's mesh has no triangles");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!mesh.vertices[v].allFinite())
      throw Error(ErrorCode::bad_mesh, fmt::format("vertex {} of the container's mesh is not finite", v));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (v >= mesh.vertices.size())
        throw Error(ErrorCode::bad_mesh,
                    fmt::format("triangle {} of the container's mesh names vertex {} of {}", t, v,
                                mesh.vertices.size()));
}

/// Exact corners that belong to other vertices would be a different wall.
void check_exact_corners(const Mesh& mesh) {
  if (!mesh.exact) return;
  const ExactCorners& exact = *mesh.exact;
  bool same = exact.scale >= 1 && exact.high.size() == mesh.vertices.size() &&
              exact.low.size() == mesh.vertices.size();
  for (std::size_t v = 0; same && v < mesh.vertices.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      const double x = mesh.vertices[v][k], high = exact.high[v][k], low = exact.low[v][k];
      same = same && high + low == high && std::abs(high / exact.scale - x) <= off_by_at_most(x);
    }
  if (!same)
    throw Error(ErrorCode::bad_mesh,
                "the exact corners of the container's mesh are not those of its vertices");
}

/// The number of directed edges without a partner in the opposite direction.
std::size_t unpaired_edges(const Triangles& triangles) {
  std::vector<std::uint64_t> up, down;
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[(k + 1) % 3];
      if (a < b) up.push_back(a << 32 | b);
      if (b < a) down.push_back(b << 32 | a);
    }
  }
  tbb::parallel_sort(up);
  tbb::parallel_sort(down);
  if (up == down) return 0;
  std::vector<std::uint64_t> unpaired;
  std::ranges::set_symmetric_difference(up, down, std::back_inserter(unpaired));
  return unpaired.size();
}

/// The same triangles with one index for all vertices at the same point.
Triangles welded(const Mesh& mesh) {
  const auto point = [&](std::uint32_t v) {
    return mesh.exact ? WidePoint{mesh.exact->high[v], mesh.exact->low[v]}
                      : WidePoint{mesh.vertices[v], Vector<3>::Zero()};
  };
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const WidePoint p = point(a), q = point(b);
    for (int k = 0; k < 3; ++k)
      if (!are_level(p, q, k)) return is_above(q, p, k);
    return false;
  };
  tbb::parallel_sort(order.begin(), order.end(), less);
  std::vector<std::uint32_t> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? first[order[i - 1]] : order[i];
  Triangles result = mesh.triangles;
  for (auto& t : result)
    for (std::uint32_t& v : t) v = first[v];
  return result;
}

void check_closed(const Mesh& mesh) {
  if (unpaired_edges(mesh.triangles) == 0) return;
  const std::size_t unpaired = unpaired_edges(welded(mesh));
  if (unpaired > 0)
    throw Error(
        ErrorCode::bad_mesh,
        fmt::format("the container's mesh is not closed and consistently oriented: {} edges have no partner "
                    "in the opposite direction; repair it first",
                    unpaired));
}

}  // namespace

/// The least of the three segments and, if p projects
/// inside, the plane: so a wrong guess of the region is harmless, even on needles.
double distance_from_triangle(const Vector<3>& p, const Corners& v) {
  double best = Box<3>::infinity;
  for (int k = 0; k < 3; ++k) best = std::min(best, distance_from_segment<3>(p, v[k], v[(k + 1) % 3]));
  const Vector<3> normal = (v[1] - v[0]).cross(v[2] - v[0]);
  const double length = normal.norm();
  bool inside = length > 0;
  for (int k = 0; k < 3 && inside; ++k) inside = normal.cross(v[(k + 1) % 3] - v[k]).dot(p - v[k]) >= 0;
  return inside ? std::min(best, std::abs(normal.dot(p - v[0])) / length) : best;
}

MeshWall::MeshWall(const Mesh& mesh)
    : mesh_(mesh), facets_(facets_of(mesh)), largest_(largest_coordinate(facets_.box())) {}

std::vector<MeshWall::Facet> MeshWall::facets_of(const Mesh& mesh) {
  check_numbers(mesh);
  check_exact_corners(mesh);
  check_closed(mesh);
  std::vector<Facet> facets(mesh.triangles.size());
  for (std::size_t t = 0; t < facets.size(); ++t) {
    facets[t].triangle = static_cast<std::uint32_t>(t);
    for (const std::uint32_t v : mesh.triangles[t]) {
      const Vector<3>& p = mesh.vertices[v];
      std::array<double, 3> lower{p[0], p[1], p[2]}, upper = lower;
      for (int k = 0; k < 3 && mesh.exact; ++k) {
        lower[k] -= off_by_at_most(p[k]);
        upper[k] += off_by_at_most(p[k]);
      }
      facets[t].extent.include({lower, upper});
    }
  }
  return facets;
}

Corners MeshWall::corners(const Facet& facet) const {
  const auto& t = mesh_.triangles[facet.triangle];
  return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
}

CornersOf<WidePoint> MeshWall::exact_corners(const Facet& facet) const {
  const auto corner = [&](std::uint32_t v) { return WidePoint{mesh_.exact->high[v], mesh_.exact->low[v]}; };
  const auto& t = mesh_.triangles[facet.triangle];
  return {corner(t[0]), corner(t[1]), corner(t[2])};
}

Truth MeshWall::clears(const Ball<3>& ball, const Reach& reach, const Facet& facet, Arithmetic arithmetic,
                       Tally& tally) const {
  if (!mesh_.exact)
    return decide(arithmetic, tally.decisions, [&]<class Number>() {
      return ball_clears_triangle<Number>(ball.c, reach, corners(facet));
    });
  const WidePoint center = times(mesh_.exact->scale, ball.c);
  const Reach scaled{reach.r, reach.gap, mesh_.exact->scale};
  return decide(arithmetic, tally.decisions, [&]<class Number>() {
    return ball_clears_triangle<Number>(center, scaled, exact_corners(facet));
  });
}

WallState MeshWall::wall_state_of(const Ball<3>& ball, const CertifyOptions& options, double least,
                                  Tally& tally) const {
  const Arithmetic arithmetic = options.arithmetic;
  const Reach reach{ball.r, options.wall_gap};
  const double largest = std::max(largest_, largest_coordinate(ball.box()));
  const double nearest_so_far = wall_reach(least, ball.r, options.wall_gap, largest);
  const Box<3> near = widened(ball.box(), wall_distances_known_up_to(options));
  // A box that is little larger holds few more triangles; from farther away the nearest is looked for alone.
  const bool is_little = nearest_so_far <= 1.25 * ball.r;
  Box<3> looked_at = near;
  if (is_little) looked_at.include(widened(ball.box(), std::max(0.0, nearest_so_far - ball.r)));
  bool clear = true;
  double distance = Box<3>::infinity;
  facets_.for_each_touching(looked_at, [&](const Facet& facet) {
    distance = std::min(distance, distance_from_triangle(ball.c, corners(facet)));
    if (!touch(facet.extent, near)) return;
    ++tally.walls;
    clear &= clears(ball, reach, facet, arithmetic, tally) == Truth::yes;
  });

  const bool center_is_inside = center_inside(ball, arithmetic, tally);
  if (!center_is_inside)
    distance = -distance_from(ball.c);
  else if (!is_little)
    distance = std::min(distance, distance_from(ball.c, nearest_so_far));
  const bool holds = center_is_inside && clear;
  WallState state{.inside = holds};
  if (distance < Box<3>::infinity) state.add(distance, reach, holds);
  return state;
}

bool MeshWall::center_inside(const Ball<3>& ball, Arithmetic arithmetic, Tally& tally) const {
  const Vector<3>& p = ball.c;
  const Box<3> upwards{{p[0], p[1], p[2]}, {p[0], p[1], Box<3>::infinity}};
  const WidePoint wide = mesh_.exact ? times(mesh_.exact->scale, p) : WidePoint{};
  int winding = 0;
  Decisions crossings;
  facets_.for_each_touching(upwards, [&](const Facet& facet) {
    winding += static_cast<int>(decide(arithmetic, crossings, [&]<class Number>() {
      return mesh_.exact ? crossing_above<Number>(wide, exact_corners(facet))
                         : crossing_above<Number>(p, corners(facet));
    }));
  });
  ++tally.centers;
  const bool by_double = arithmetic == Arithmetic::filtered && crossings.by_exact == 0;
  ++(by_double ? tally.decisions.by_double : tally.decisions.by_exact);
  return winding == 1;
}

double MeshWall::distance_from(const Vector<3>& p, double below) const {
  const double largest = std::max(largest_, p.cwiseAbs().maxCoeff());
  const double nearest = facets_.nearest(
      [&](const Box<3>& box) { return least_distance_from_box(p, box, largest); },
      [&](const Facet& facet, double) { return distance_from_triangle(p, corners(facet)); }, below);
  return nearest < below ? nearest : Box<3>::infinity;
}

bool MeshWall::is_farther_than(const Vector<3>& p, double distance) const {
  const double more = (1 + 1e-9) * distance;
  double least = Box<3>::infinity;
  facets_.for_each_touching(box_of_ball<3>(p, more), [&](const Facet& facet) {
    least = std::min(least, distance_from_triangle(p, corners(facet)));
  });
  return least > more;
}

}  // namespace bernal::verify
