#include "measure/flat_walls.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/disjoint_sets.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/edges.hpp"

namespace bernal {
namespace {

/// Of lengths near 1: how far a corner may be off a flat wall, and how far out of a convex domain.
constexpr double off_a_wall = 1e-9;
/// Of the reach of a cell: smaller cuts are rounding.
constexpr double rounding_at_walls = 1e-12;

/// How far the sides and the corners of a regular polygon are from its middle that has the area of the disc.
struct Polygonal {
  double sides, corners;
};
Polygonal polygonal(double radius, int sides) {
  const double step = 2 * std::numbers::pi / sides, corners = radius * std::sqrt(step / std::sin(step));
  return {corners * std::cos(0.5 * step), corners};
}

class Planes {
 public:
  explicit Planes(const Mesh& mesh) : mesh_(mesh), sets_(mesh.triangles.size()) {
    for (const FaceCorners& t : mesh.triangles) {
      twice_areas_.push_back((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])));
    }
    MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
      if (uses.size() == 2 && are_one_plane(uses[0].triangle, uses[1].triangle))
        sets_.unite(uses[0].triangle, uses[1].triangle);
    });
  }

  std::vector<Cells::Wall> walls() {
    std::map<std::uint32_t, std::uint32_t> largest;  // triangle of each set
    for (std::uint32_t t = 0; t < twice_areas_.size(); ++t) {
      if (!has_area(t)) continue;
      const auto [of_set, is_first] = largest.try_emplace(sets_.find(t), t);
      if (!is_first && twice_areas_[t].squaredNorm() > twice_areas_[of_set->second].squaredNorm())
        of_set->second = t;
    }
    std::vector<Cells::Wall> made;
    for (const auto& [set, triangle] : largest) made.push_back(plane_of(triangle));
    return without_twins(made);
  }

 private:
  const Vector<3>& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  bool has_area(std::uint32_t t) const { return twice_areas_[t].norm() > off_a_wall * off_a_wall; }
  Cells::Wall plane_of(std::uint32_t t) const {
    const Vector<3> normal = twice_areas_[t].stableNormalized();
    double offset = normal.dot(at(mesh_.triangles[t][0]));
    for (const std::uint32_t corner : mesh_.triangles[t]) offset = std::max(offset, normal.dot(at(corner)));
    return {normal, offset, {}};
  }
  bool are_one_plane(std::uint32_t a, std::uint32_t b) const {
    if (!has_area(a) || !has_area(b)) return false;
    for (const auto& [of, other] : {std::pair{a, b}, {b, a}}) {
      const Cells::Wall plane = plane_of(of);
      for (const std::uint32_t corner : mesh_.triangles[other])
        if (std::abs(plane.normal.dot(at(corner)) - plane.offset) > off_a_wall) return false;
    }
    return twice_areas_[a].dot(twice_areas_[b]) > 0;
  }
  /// Triangles of one plane need not hang together.
  static std::vector<Cells::Wall> without_twins(const std::vector<Cells::Wall>& all) {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return all[k].offset; });
    std::vector<bool> is_twin(all.size());
    for (std::size_t a = 0; a < order.size(); ++a)
      for (std::size_t b = a + 1;
           b < order.size() && all[order[b]].offset - all[order[a]].offset < off_a_wall; ++b)
        if ((all[order[a]].normal - all[order[b]].normal).norm() < off_a_wall)
          is_twin[std::max(order[a], order[b])] = true;
    std::vector<Cells::Wall> made;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (!is_twin[k]) made.push_back(all[k]);
    return made;
  }

  const Mesh& mesh_;
  DisjointSets sets_;
  std::vector<Vector<3>> twice_areas_;
};

[[noreturn]] void refuse_hollow(const Domain& domain) {
  throw Error(ErrorCode::bad_argument,
              fmt::format("the {} is not convex, and the cells at its walls need not be: polyhedra are those "
                          "of convex containers; an image of the cells is made of any, as nrrd, vti or npy",
                          name_of(domain)));
}

struct Flat {
  const Domain& domain;
  int sides;
  FlatWalls made = {};

  void operator()(const Box& box) {
    made.dimension = box.dimension();
    made.are_of_box = true;
    made.around = bounds_of(domain);
    for (int k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      made.walls.push_back({-Vector<3>::Unit(k), -made.around.lower[k], axis + "0"});
      made.walls.push_back({Vector<3>::Unit(k), made.around.upper[k], axis + "1"});
    }
  }
  void operator()(const Cylinder& cylinder) {
    const Vector<3> axis = cylinder.axis.stableNormalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
    const Polygonal polygon = polygonal(cylinder.radius, sides);
    made.deviation = std::max(cylinder.radius - polygon.sides, polygon.corners - cylinder.radius);
    if (!cylinder.periodic) {
      const double low = axis.dot(cylinder.base);
      made.walls.push_back({-axis, -low, "z0"});
      made.walls.push_back({axis, low + cylinder.height, "z1"});
    }
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const Vector<3> normal = std::cos(angle) * u + std::sin(angle) * v;
      made.walls.push_back({normal, normal.dot(cylinder.base) + polygon.sides, {}});
    }
    set_bounds();
  }
  void operator()(const Sphere& ball) {
    Revolved solid{.base = ball.center};
    const int rings = sides / 2;
    for (int k = 0; k <= rings; ++k) {
      const double angle = std::numbers::pi * k / rings;
      solid.profile.emplace_back(k == 0 || k == rings ? 0 : ball.radius * std::sin(angle),
                                 -ball.radius * std::cos(angle));
    }
    Mesh mesh = surface_of(solid, sides);
    const double factor = std::cbrt(volume_of(ball) / volume_of(mesh));
    for (Vector<3>& vertex : mesh.vertices) {
      vertex = ball.center + factor * (vertex - ball.center);
      made.deviation = std::max(made.deviation, (vertex - ball.center).norm() - ball.radius);
    }
    (*this)(mesh);
    for (const Cells::Wall& wall : made.walls)
      made.deviation = std::max(made.deviation, ball.radius - (wall.offset - wall.normal.dot(ball.center)));
  }
  void operator()(const Revolved& solid) {
    double radius = 0;
    for (const Vector<2>& p : solid.profile) radius = std::max(radius, p[0]);
    const Polygonal polygon = polygonal(radius, sides);
    made.deviation = std::max(radius - polygon.sides, polygon.corners - radius);
    (*this)(surface_of(solid, sides, RoundAs::of_same_area));
  }
  void operator()(const Mesh& mesh) {
    made.walls = Planes(mesh).walls();
    for (const Cells::Wall& wall : made.walls)
      for (const Vector<3>& vertex : mesh.vertices)
        if (wall.normal.dot(vertex) - wall.offset > off_a_wall) refuse_hollow(domain);
    set_bounds();
  }
  void operator()(const Polygon& polygon) {
    made.dimension = 2;
    if (polygon.loops.size() != 1) refuse_hollow(domain);
    const std::vector<Vector<2>>& loop = polygon.loops[0];
    double twice = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      twice += a[0] * b[1] - a[1] * b[0];
    }
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      if (a == b) continue;
      const Vector<2> along = (b - a).normalized() * (twice > 0 ? 1 : -1);
      const Vector<3> normal(along[1], -along[0], 0);
      made.walls.push_back({normal, normal.head<2>().dot(a), {}});
      for (const Vector<2>& p : loop)
        if (normal.head<2>().dot(p) - made.walls.back().offset > off_a_wall) refuse_hollow(domain);
    }
    set_bounds();
  }

  void set_bounds() {
    made.around = bounds_of(domain);
    const Vector<3> margin = Vector<3>::Constant(0.1 * made.around.diagonal());
    made.around.lower -= margin;
    made.around.upper += margin;
    int unnamed = 0;
    for (Cells::Wall& wall : made.walls)
      if (wall.name.empty()) wall.name = fmt::format("f{}", ++unnamed);
  }
};

}  // namespace

FlatWalls flat_walls_of(const Domain& domain, int sides) {
  Flat flat{domain, sides};
  std::visit(flat, domain);
  return flat.made;
}

void FlatWalls::cut_by_nearest(ConvexCell& cell, const Vector<3>& center) const {
  if (walls.empty()) return;
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (const double depth = walls[k].offset - walls[k].normal.dot(center); depth < least) {
      least = depth;
      nearest = k;
    }
  cell.cut(walls[nearest].normal, least, label_of_wall(nearest));
}

void FlatWalls::cut(ConvexCell& cell, const Vector<3>& center) const {
  const double reach = std::sqrt(cell.squared_reach()), slack = rounding_at_walls * reach;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (const double depth = walls[k].offset - walls[k].normal.dot(center); depth < reach)
      near.emplace_back(depth, k);
  std::ranges::sort(near);
  for (const auto& [depth, k] : near) cell.cut(walls[k].normal, depth, label_of_wall(k), slack);
}

}  // namespace bernal
