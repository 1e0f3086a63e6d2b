#include "cad/repair/wrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bernal/core/error.hpp"
#include "cad/repair/cgal_surfaces.hpp"
#include "cad/triangle_tree.hpp"
#include "core/parallel.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {
namespace {

constexpr std::size_t most_points = 500'000;
constexpr double offset_over_alpha = 1.0 / 30, alpha_over_diagonal = 1.0 / 100;
/// A seed begins with a ball of 1.65 alpha, which should not reach into the surface: the required distance
/// from it; and the depth below the faces at which to look for seeds, relative to that distance.
constexpr double seed_over_alpha = 1.7 + offset_over_alpha, look_below = 1.02;
/// Points along the longest edge of the bounds at which to look for the inside.
constexpr int looks_along_edge = 32;
/// The largest number of points to try below the faces.
constexpr double most_looks_below = 50'000;
constexpr std::size_t most_seeds = 64, most_seeds_in_nooks = 1000;

/// Whether at least five of the six rays along the axes cross the surface an odd number of times.
bool is_inside(const TriangleTree& tree, const Vector<3>& p) {
  int odd = 0;
  for (int way = 0; way < 6 && odd + 6 - way >= 5; ++way)
    odd += tree.crossing(p, way / 2,
                         way % 2 == 0 ? std::numeric_limits<double>::infinity()
                                      : -std::numeric_limits<double>::infinity()) == Crossing::odd;
  return odd >= 5;
}

struct Seed {
  double distance;
  Vector<3> place;
};

/// Points at which to test for the inside: a grid, which finds wide spaces.
std::vector<Vector<3>> grid_of_places(const Bounds<3>& bounds) {
  std::vector<Vector<3>> places;
  const double step = bounds.size().maxCoeff() / looks_along_edge;
  std::array<int, 3> count;
  for (int k = 0; k < 3; ++k) count[k] = std::max(1, static_cast<int>(std::ceil(bounds.size()[k] / step)));
  const Vector<3> cell = bounds.size().cwiseQuotient(Vector<3>(count[0], count[1], count[2]));
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x)
        // Off the middle of the cells, because faces of parts are often at halves and thirds.
        places.push_back(bounds.lower +
                         (Vector<3>(x, y, z) + Vector<3>(0.4871, 0.5113, 0.4937)).cwiseProduct(cell));
  return places;
}

/// Points at the depth of a seed below the faces, on both sides, which find thin spaces.
std::vector<Vector<3>> places_below_faces(const Mesh& mesh, double depth) {
  std::vector<Vector<3>> places;
  const double apart = std::max(2 * depth, std::sqrt(area_of(mesh) / most_looks_below));
  double owed = 0;  // fraction of a point owed by the faces so far, so that small ones share one
  for (const auto& t : mesh.triangles) {
    const Vector<3> normal = doubled_area(mesh, t);
    owed += normal.norm() / 2 / (apart * apart);
    const int looks = static_cast<int>(owed);
    owed -= looks;
    const Vector<3>&a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    for (int k = 0; k < looks; ++k) {
      // Roberts's sequence fills the parallelogram evenly; its upper half is folded onto the lower.
      double u = std::fmod(0.5 + 0.7548776662466927 * k, 1), v = std::fmod(0.5 + 0.5698402909980532 * k, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vector<3> p = a + (looks == 1 ? 1.0 / 3 : u) * (b - a) + (looks == 1 ? 1.0 / 3 : v) * (c - a);
      for (const double side : {depth, -depth}) places.push_back(p + side * normal.stableNormalized());
    }
  }
  return places;
}

/// Points inside, farther than `least` from the surface, the farthest first.
std::vector<Seed> points_inside(const Mesh& mesh, const std::vector<Vector<3>>& places, double least,
                                const Monitor& monitor) {
  const TriangleTree tree(mesh);
  std::vector<Seed> all(places.size(), {0, Vector<3>::Zero()});
  constexpr std::size_t at_a_time = 4096;
  for (std::size_t begin = 0; begin < all.size() && !monitor.stop(); begin += at_a_time)
    parallel_for(begin, std::min(all.size(), begin + at_a_time), [&](std::size_t i) {
      const double d = tree.distance(places[i], std::numeric_limits<double>::infinity());
      if (d > least && is_inside(tree, places[i])) all[i] = {d, places[i]};
    });
  std::erase_if(all, [](const Seed& seed) { return seed.distance == 0; });
  std::stable_sort(all.begin(), all.end(),
                   [](const Seed& a, const Seed& b) { return a.distance > b.distance; });
  return all;
}

/// Seeds none of which is nearer to another than to the surface.
std::vector<Seed> scattered(const std::vector<Seed>& all, std::size_t most) {
  std::vector<Seed> seeds;
  for (const Seed& candidate : all) {
    if (seeds.size() == most) break;
    if (std::all_of(seeds.begin(), seeds.end(), [&](const Seed& s) {
          return (s.place - candidate.place).norm() > std::max(candidate.distance, s.distance);
        }))
      seeds.push_back(candidate);
  }
  return seeds;
}

/// Wrapped from these seeds, or from outside if there are none. Throws StoppedWrap.
Mesh wrapped(const Mesh& mesh, double alpha, double offset, const std::vector<Seed>& seeds,
             const Monitor& monitor) {
  std::vector<Vector<3>> from;
  for (const Seed& seed : seeds) from.push_back(seed.place);
  return alpha_wrap(mesh, alpha, offset, from, most_points, monitor);
}

/// The seeds that a wrap has not reached: they lie in other chambers.
std::vector<Seed> outside_of(const Mesh& wrap, const std::vector<Seed>& inside) {
  if (wrap.triangles.empty()) return {};
  const TriangleTree tree(wrap);
  std::vector<Seed> left;
  for (const Seed& seed : inside)
    if (tree.crossing(seed.place, 0, std::numeric_limits<double>::infinity()) == Crossing::even)
      left.push_back(seed);
  return scattered(left, most_seeds_in_nooks);
}

/// Removes seeds from which the wrap gets out, because they are not inside or their chamber has a gap; found
/// by halving.
template <class WrapFrom>
std::vector<Seed> keep_inside(const std::vector<Seed>& seeds, const WrapFrom& wrap_from) {
  if (seeds.empty()) return {};
  try {
    wrap_from(seeds);
    return seeds;
  } catch (StoppedWrap reason) {
    if (reason != StoppedWrap::outside) throw;
    if (seeds.size() == 1) return {};
  }
  const auto middle = seeds.begin() + std::ssize(seeds) / 2;
  std::vector<Seed> stay = keep_inside({seeds.begin(), middle}, wrap_from);
  const std::vector<Seed> others = keep_inside({middle, seeds.end()}, wrap_from);
  stay.insert(stay.end(), others.begin(), others.end());
  return stay;
}

/// Whether a wrapped surface encloses hardly more than the offset on both sides of a sheet.
bool is_only_a_skin(const Mesh& mesh, double offset) {
  constexpr double more = 1.5;  // at its rim, and where it bends
  return signed_volume(mesh) < more * area_of(mesh) * offset;
}

bool lies_within(const Mesh& mesh, const Bounds<3>& bounds) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vector<3>& v) {
    return (v.array() >= bounds.lower.array()).all() && (v.array() <= bounds.upper.array()).all();
  });
}

/// The largest alpha for which a sphere of that radius is a seed wherever it fits, with the default offset.
double alpha_for(double radius) { return radius / look_below / seed_over_alpha; }

constexpr std::string_view from_inside = "wrapped from inside";
constexpr std::string_view close_first = "close its openings by \"cap\" or repair = [\"holes\"] first";

}  // namespace

RepairedMesh wrap(Mesh mesh, double alpha, double offset, const Monitor& monitor) {
  if (!(alpha >= 0) || !(offset >= 0) || !std::isfinite(alpha) || !std::isfinite(offset))
    throw Error(ErrorCode::bad_argument,
                "alpha and offset of a wrap are lengths above 0; give 0 for the default");
  if (mesh.triangles.empty()) return {std::move(mesh), "not wrapped: it has no faces"};
  const Bounds<3> bounds = bounds_of_faces(mesh);
  if (alpha == 0) alpha = alpha_over_diagonal * bounds.diagonal();
  if (offset == 0) offset = offset_over_alpha * alpha;
  if (!(offset > 0)) return {std::move(mesh), "not wrapped: it has no extent"};
  const std::string how = fmt::format("alpha {:.4g}, offset {:.4g}", alpha, offset);

  try {
    const double deep = (seed_over_alpha - offset_over_alpha) * alpha + offset;
    std::vector<Seed> inside = points_inside(mesh, grid_of_places(bounds), offset, monitor);
    std::vector<Seed> in_nooks =
        points_inside(mesh, places_below_faces(mesh, look_below * deep), deep, monitor);
    if (monitor.stop()) throw StoppedWrap::by_monitor;
    if (inside.empty() || !(inside.front().distance > deep)) {
      if (!in_nooks.empty()) inside = std::exchange(in_nooks, {});
    } else {
      std::erase_if(inside, [&](const Seed& seed) { return !(seed.distance > deep); });
      in_nooks.insert(in_nooks.end(), inside.begin(), inside.end());
    }
    std::vector<Seed> seeds = scattered(inside, most_seeds);
    std::string why = "no inside was found";
    if (!seeds.empty()) {
      const auto wrap_from = [&](const std::vector<Seed>& some) {
        Mesh made = wrapped(mesh, alpha, offset, some, monitor);
        if (!lies_within(made, bounds)) throw StoppedWrap::outside;
        return made;
      };
      Mesh inner = wrap_from(seeds);
      const std::vector<Seed> nooks = keep_inside(outside_of(inner, in_nooks), wrap_from);
      if (!nooks.empty()) {
        seeds.insert(seeds.end(), nooks.begin(), nooks.end());
        inner = wrap_from(seeds);
      }
      if (!inner.triangles.empty())
        return {std::move(inner),
                fmt::format("{} ({}): the result lies within the surface", from_inside, how)};
      why = "the inside is too narrow for alpha";
    }
    Mesh outer = wrapped(mesh, alpha, offset, {}, monitor);
    if (outer.triangles.empty())
      return {std::move(mesh),
              fmt::format("not wrapped ({}): the result is empty; close its gaps in CAD", how)};
    if (is_only_a_skin(outer, offset))
      return {std::move(mesh),
              fmt::format("not wrapped ({}): {}, and from outside only the skin of a sheet results; {}", how,
                          why, close_first)};
    return {
        std::move(outer),
        fmt::format("wrapped from outside ({}) because {}: the surface lies within the result", how, why)};
  } catch (StoppedWrap reason) {
    const std::string_view because =
        reason == StoppedWrap::by_monitor ? "it was cancelled"
        : reason == StoppedWrap::too_many
            ? "the result would have more than a million faces; take a larger alpha"
            : "the inside is open to the outside through gaps wider than alpha";
    return {std::move(mesh),
            fmt::format("not wrapped ({}): {}{}", how, because,
                        reason == StoppedWrap::outside ? fmt::format("; {}", close_first) : "")};
  } catch (const std::exception& error) {
    std::string message = error.what();
    std::replace(message.begin(), message.end(), '\n', ' ');
    return {std::move(mesh), fmt::format("not wrapped ({}): {}", how, message)};
  }
}

RepairedMesh wrap_for_spheres(const Mesh& mesh, double radius, const Monitor& monitor) {
  if (mesh.triangles.empty() || !(radius > 0)) return wrap(mesh, 0, 0, monitor);
  const double coarsest = alpha_over_diagonal * bounds_of_faces(mesh).diagonal();
  const double wanted = alpha_for(radius);
  const double finest = std::sqrt(3 * area_of(mesh) / static_cast<double>(most_points));
  std::string_view why = wanted < finest ? "would have more than a million faces" : "";
  for (double alpha = std::max(wanted, finest);; alpha *= 2) {
    alpha = std::min(alpha, coarsest);
    RepairedMesh repaired = wrap(mesh, alpha, 0, monitor);
    const bool is_done = repaired.done.starts_with(from_inside);
    if (!is_done && alpha < coarsest && !monitor.stop()) {
      why = "leaves the part through its gaps";
      continue;
    }
    if (is_done && alpha > wanted && !why.empty())
      repaired.done += fmt::format(
          "; a finer one {}, so places are lost where only spheres of a radius below "
          "{:.3g} fit",
          why, alpha / wanted * radius);
    return repaired;
  }
}

}  // namespace bernal::cad
