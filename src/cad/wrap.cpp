#include "cad/wrap.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bernal/core/error.hpp"
#include "cad/triangle_tree.hpp"
#include "core/parallel.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

constexpr std::size_t most_points = 500'000;
/// Points along the longest edge of the bounds at which to look for the inside.
constexpr int looks_along_edge = 32;
constexpr std::size_t most_seeds = 64;

enum class Stopped { by_monitor, too_many, outside };

/// CGAL's door for a look at the work while it goes on.
struct Watch {
  const Monitor& monitor;
  std::size_t points = 0;

  template <class Wrapper>
  void on_alpha_wrapping_begin(const Wrapper&) {}
  template <class Wrapper>
  void on_flood_fill_begin(const Wrapper&) {}
  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate&) {}
  template <class Wrapper, class Place>
  void before_Steiner_point_insertion(const Wrapper&, const Place&) {}
  template <class Wrapper, class Vertex>
  void after_Steiner_point_insertion(const Wrapper&, Vertex) {
    if (++points > most_points) throw Stopped::too_many;
    if (points % 256 == 0 && monitor.stop()) throw Stopped::by_monitor;
  }
  template <class Wrapper>
  void on_flood_fill_end(const Wrapper&) {}
  template <class Wrapper>
  void on_alpha_wrapping_end(const Wrapper&) {}
};

Bounds<3> bounds_of_faces(const Mesh& mesh) {
  Bounds<3> bounds{Vector<3>::Constant(std::numeric_limits<double>::infinity()),
                   Vector<3>::Constant(-std::numeric_limits<double>::infinity())};
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) {
      bounds.lower = bounds.lower.cwiseMin(mesh.vertices[i]);
      bounds.upper = bounds.upper.cwiseMax(mesh.vertices[i]);
    }
  return bounds;
}

/// Whether at least five of the six ways along the axes leave the surface by an odd number of crossings.
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

/// Points inside, the farthest from the surface first, none nearer to another than that is to the surface.
/// Only those farther than `least` are of use.
std::vector<Seed> points_inside(const Mesh& mesh, const Bounds<3>& bounds, double least,
                                const Monitor& monitor) {
  const TriangleTree tree(mesh);
  const double step = bounds.size().maxCoeff() / looks_along_edge;
  std::array<int, 3> count;
  for (int k = 0; k < 3; ++k) count[k] = std::max(1, static_cast<int>(std::ceil(bounds.size()[k] / step)));
  const Vector<3> cell = bounds.size().cwiseQuotient(Vector<3>(count[0], count[1], count[2]));
  const std::size_t layer = static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
  std::vector<Seed> all(layer * static_cast<std::size_t>(count[2]), {0, Vector<3>::Zero()});
  for (int z = 0; z < count[2] && !monitor.stop(); ++z)
    parallel_for(layer, [&](std::size_t i) {
      const int n = static_cast<int>(i);
      // Off the middle of the cells, because faces of parts stand at halves and thirds.
      const Vector<3> at = Vector<3>(n % count[0], n / count[0], z) + Vector<3>(0.4871, 0.5113, 0.4937);
      const Vector<3> p = bounds.lower + at.cwiseProduct(cell);
      const double d = tree.distance(p, std::numeric_limits<double>::infinity());
      if (d > least && is_inside(tree, p)) all[static_cast<std::size_t>(z) * layer + i] = {d, p};
    });
  std::stable_sort(all.begin(), all.end(),
                   [](const Seed& a, const Seed& b) { return a.distance > b.distance; });
  std::vector<Seed> seeds;
  for (const Seed& candidate : all) {
    if (candidate.distance == 0 || seeds.size() == most_seeds) break;
    if (std::all_of(seeds.begin(), seeds.end(), [&](const Seed& s) {
          return (s.place - candidate.place).norm() > std::max(candidate.distance, s.distance);
        }))
      seeds.push_back(candidate);
  }
  return seeds;
}

Point wrap_point(const Vector<3>& p) { return {p[0], p[1], p[2]}; }

/// Wrapped from these points, or from outside if there are none. Throws Stopped.
Surface wrapped(const Mesh& mesh, double alpha, double offset, const std::vector<Seed>& seeds,
                const Monitor& monitor) {
  std::vector<Point> points, from;
  for (const Vector<3>& v : mesh.vertices) points.push_back(wrap_point(v));
  for (const Seed& seed : seeds) from.push_back(wrap_point(seed.place));
  Watch watch{monitor};
  Surface surface;
  CGAL::alpha_wrap_3(points, mesh.triangles, alpha, offset, surface, CGAL::parameters::default_values(),
                     CGAL::parameters::seed_points(std::ref(from)).visitor(std::ref(watch)));
  return surface;
}

/// Oriented outwards.
Mesh outward_mesh_of(const Surface& surface) {
  Mesh mesh;
  for (const auto v : surface.vertices()) {
    const Point& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : surface.faces()) {
    std::array<std::uint32_t, 3> triangle;
    int k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(face)))
      triangle[k++] = static_cast<std::uint32_t>(v.idx());
    mesh.triangles.push_back(triangle);
  }
  if (!mesh.triangles.empty() && volume_of(Domain(mesh)) < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Whether a wrapped surface holds next to nothing but the offset from a sheet, on both of its sides.
bool is_but_a_skin(const Mesh& mesh, double offset) {
  double area = 0;
  for (const auto& [i, j, k] : mesh.triangles)
    area += 0.5 * (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]).norm();
  constexpr double more = 1.5;  // at its rim, and where it bends
  return volume_of(Domain(mesh)) < more * area * offset;
}

bool lies_within(const Mesh& mesh, const Bounds<3>& bounds) {
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vector<3>& v) {
    return (v.array() >= bounds.lower.array()).all() && (v.array() <= bounds.upper.array()).all();
  });
}

constexpr std::string_view close_first = "close its openings by \"cap\" or repair = [\"holes\"] first";

}  // namespace

Mended wrap(Mesh mesh, double alpha, double offset, const Monitor& monitor) {
  if (!(alpha >= 0) || !(offset >= 0) || !std::isfinite(alpha) || !std::isfinite(offset))
    throw Error(ErrorCode::bad_argument, "alpha and offset of a wrap are lengths, or 0 for the default");
  if (mesh.triangles.empty()) return {std::move(mesh), "not wrapped: it has no faces"};
  const Bounds<3> bounds = bounds_of_faces(mesh);
  if (alpha == 0) alpha = bounds.diagonal() / 100;
  if (offset == 0) offset = alpha / 30;
  if (!(offset > 0)) return {std::move(mesh), "not wrapped: it has no extent"};
  const std::string how = fmt::format("alpha {:.4g}, offset {:.4g}", alpha, offset);

  try {
    // A seed begins with a ball of 1.65 alpha, which may reach into the surface, though better not.
    std::vector<Seed> seeds = points_inside(mesh, bounds, offset, monitor);
    if (monitor.stop()) throw Stopped::by_monitor;
    const auto deep = std::count_if(seeds.begin(), seeds.end(),
                                    [&](const Seed& s) { return s.distance > 1.7 * alpha + offset; });
    if (deep > 0) seeds.resize(static_cast<std::size_t>(deep));
    std::string why = "no inside was found";
    if (!seeds.empty()) {
      Mesh inner = outward_mesh_of(wrapped(mesh, alpha, offset, seeds, monitor));
      if (!lies_within(inner, bounds)) throw Stopped::outside;
      if (!inner.triangles.empty())
        return {std::move(inner),
                fmt::format("wrapped from inside ({}): the result lies within the surface", how)};
      why = "the inside is too narrow for alpha";
    }
    Mesh outer = outward_mesh_of(wrapped(mesh, alpha, offset, {}, monitor));
    if (outer.triangles.empty())
      return {std::move(mesh), fmt::format("not wrapped ({}): nothing came out", how)};
    if (is_but_a_skin(outer, offset))
      return {std::move(mesh),
              fmt::format("not wrapped ({}): {}, and from outside there is but the skin of a sheet; {}", how,
                          why, close_first)};
    return {
        std::move(outer),
        fmt::format("wrapped from outside ({}) because {}: the surface lies within the result", how, why)};
  } catch (Stopped reason) {
    const std::string_view because =
        reason == Stopped::by_monitor ? "it was cancelled"
        : reason == Stopped::too_many ? "the result would have more than a million faces; take a larger alpha"
                                      : "the inside is open to the outside through gaps wider than alpha";
    return {std::move(mesh), fmt::format("not wrapped ({}): {}{}", how, because,
                                         reason == Stopped::outside ? fmt::format("; {}", close_first) : "")};
  } catch (const std::exception& error) {
    std::string said = error.what();
    std::replace(said.begin(), said.end(), '\n', ' ');
    return {std::move(mesh), fmt::format("not wrapped ({}): {}", how, said)};
  }
}

}  // namespace bernal::cad
