#include "hard/table/random_polyhedra.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "domain/places.hpp"
#include "support/meshes.hpp"

namespace bernal::hard {
namespace {

std::size_t below(Random& random, std::size_t n) {
  return static_cast<std::size_t>(random.uniform() * double(n));
}

/// Turned, sheared a little and moved, so that nothing lies along an axis.
Mesh askew(Mesh mesh, Random& random) {
  const Vector<3> z = uniform_direction<3>(random), x = z.unitOrthogonal(), y = z.cross(x);
  const double shear = random.uniform(-0.5, 0.5);
  const Vector<3> away(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
  for (Vector<3>& v : mesh.vertices) v = away + v[0] * x + v[1] * y + (v[2] + shear * v[0]) * z;
  return mesh;
}

/// The hull of random points: a face has all others on one side.
Mesh hull(Random& random) {
  Mesh mesh;
  const std::size_t n = 4 + below(random, 24);
  const Vector<3> axes(1, std::pow(10, random.uniform(-2, 0)), std::pow(10, random.uniform(-1, 1)));
  std::vector<Vector<3>> points;
  while (points.size() < n) points.push_back(axes.cwiseProduct(uniform_direction<3>(random)));
  std::map<std::size_t, std::uint32_t> corner;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vector<3> normal = (points[j] - points[i]).cross(points[k] - points[i]);
        std::size_t above = 0, under = 0;
        for (std::size_t m = 0; m < n; ++m) {
          if (m == i || m == j || m == k) continue;
          ++(normal.dot(points[m] - points[i]) > 0 ? above : under);
        }
        if (above && under) continue;
        std::array<std::uint32_t, 3> face;
        std::size_t v = 0;
        for (const std::size_t point : {i, j, k}) {
          const auto [at, is_new] = corner.try_emplace(point, test::index(mesh.vertices.size()));
          if (is_new) mesh.vertices.push_back(points[point]);
          face[v++] = at->second;
        }
        if (above) std::swap(face[0], face[1]);
        mesh.triangles.push_back(face);
      }
  return askew(std::move(mesh), random);
}

/// The surface of the cells that are `full` in a grid of planes at `at[k]`; corners as they are met.
Mesh surface_of(const std::array<std::vector<double>, 3>& at, const auto& full) {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> corners;
  const auto corner = [&](const std::array<int, 3>& c) {
    const auto [found, is_new] = corners.try_emplace(c, test::index(mesh.vertices.size()));
    if (is_new)
      mesh.vertices.emplace_back(at[0][static_cast<std::size_t>(c[0])], at[1][static_cast<std::size_t>(c[1])],
                                 at[2][static_cast<std::size_t>(c[2])]);
    return found->second;
  };
  const auto cells = [&](int k) { return static_cast<int>(at[static_cast<std::size_t>(k)].size()) - 1; };
  for (int x = 0; x < cells(0); ++x)
    for (int y = 0; y < cells(1); ++y)
      for (int z = 0; z < cells(2); ++z) {
        const std::array<int, 3> cell = {x, y, z};
        if (!full(cell)) continue;
        for (int k = 0; k < 3; ++k)
          for (const int side : {0, 1}) {
            std::array<int, 3> beside = cell;
            beside[static_cast<std::size_t>(k)] += side ? 1 : -1;
            if (full(beside)) continue;
            const auto u = static_cast<std::size_t>((k + 1) % 3), w = static_cast<std::size_t>((k + 2) % 3);
            std::array<std::uint32_t, 4> quad;
            for (std::size_t q = 0; q < 4; ++q) {
              std::array<int, 3> c = cell;
              c[static_cast<std::size_t>(k)] += side;
              c[u] += q == 1 || q == 2;
              c[w] += q >= 2;
              quad[q] = corner(c);
            }
            if (!side) std::swap(quad[1], quad[3]);
            mesh.triangles.push_back({quad[0], quad[1], quad[2]});
            mesh.triangles.push_back({quad[0], quad[2], quad[3]});
          }
      }
  return mesh;
}

/// Cells of a grid with random planes; `thin`: every other layer is a wall of any thinness, with gaps.
Mesh cells(Random& random, bool thin) {
  std::array<std::vector<double>, 3> at;
  for (auto& planes : at) {
    planes = {0};
    const std::size_t n = thin ? 3 + 2 * below(random, 2) : 2 + below(random, 4);
    for (std::size_t i = 0; i < n; ++i)
      planes.push_back(planes.back() +
                       (thin && i % 2 ? std::pow(10, random.uniform(-7, -1)) : random.uniform(0.2, 1)));
  }
  const auto count = [&](std::size_t k) { return static_cast<int>(at[k].size()) - 1; };
  std::map<std::array<int, 3>, bool> is_full;
  for (int x = 0; x < count(0); ++x)
    for (int y = 0; y < count(1); ++y)
      for (int z = 0; z < count(2); ++z) {
        const bool wall = thin && (x % 2 || y % 2 || z % 2);
        is_full[{x, y, z}] = random.uniform() < (wall ? 0.25 : thin ? 1 : 0.65);
      }
  is_full[{0, 0, 0}] = true;
  const auto full = [&](const std::array<int, 3>& c) {
    const auto found = is_full.find(c);
    return found != is_full.end() && found->second;
  };
  // Where two cells meet in an edge alone, four faces would: a neighbour is filled until there is none.
  for (bool changed = true; changed;) {
    changed = false;
    for (auto& [c, filled] : is_full)
      for (std::size_t k = 0; k < 3 && !filled; ++k)
        for (const int u : {-1, 1})
          for (const int w : {-1, 1}) {
            std::array<int, 3> a = c, b = c, across = c;
            a[(k + 1) % 3] += u, b[(k + 2) % 3] += w;
            across[(k + 1) % 3] += u, across[(k + 2) % 3] += w;
            if (full(a) && full(b) && !full(across)) filled = changed = true;
          }
  }
  return askew(surface_of(at, full), random);
}
Mesh boxes(Random& random) { return cells(random, false); }
Mesh rooms(Random& random) { return cells(random, true); }

/// A star-shaped polygon with spikes, drawn out and twisted.
Mesh extrusion(Random& random) {
  const std::size_t n = 3 + below(random, 40);
  const double height = random.uniform(0.2, 3), twist = random.uniform(-0.5, 0.5) / (double(n) * height);
  std::vector<double> radius(n);
  for (double& r : radius) r = random.uniform(0.15, 1);
  Mesh mesh;
  for (const double z : {0.0, height}) {
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * double(i) / double(n) + twist * z;
      mesh.vertices.emplace_back(radius[i] * std::cos(angle), radius[i] * std::sin(angle), z);
    }
    mesh.vertices.emplace_back(0, 0, z);
  }
  const std::uint32_t up = test::index(n) + 1;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % test::index(n);
    mesh.triangles.insert(
        mesh.triangles.end(),
        {{i, j, up + j}, {i, up + j, up + i}, {j, i, up - 1}, {up + i, up + j, 2 * up - 1}});
  }
  return askew(std::move(mesh), random);
}

}  // namespace

const std::vector<Family>& families_of_polyhedra() {
  static const std::vector<Family> families = {
      {"Hulls", "convex hulls of 4 to 27 points, flat ones among them", hull},
      {"Boxes", "boxes united and subtracted: cells of a grid of any spacing", boxes},
      {"Rooms", "rooms between walls of 1e-7 to 0.1, with gaps in them", rooms},
      {"Extrusions", "spiky polygons, drawn out and twisted", extrusion},
  };
  return families;
}

Case case_of(const Family& family, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  const Mesh mesh = family.make(random);
  // As large as leaves room for thirty, but well below the largest that fits anywhere.
  const Frame frame = frame_of(mesh);
  const auto container = make_local_container(mesh, frame, WallArithmetic::plain);
  double room = 0;
  const auto anywhere = [&](std::size_t) { return uniform_point(random, container->bounds()); };
  for (const Vector<3>& p : points_inside(*container, 500, 1, anywhere))
    room = std::max(room, frame.scale * container->clearance(p));
  const double radius = std::min(0.6 * room, std::cbrt(0.3 * volume_of(Domain(mesh)) / (30 * 4.18879)));
  const Protocol& protocol = protocols()[seed % protocols().size()];
  const std::string stages = protocol.name == "grow" && family.name != "Hulls" ? "" : protocol.stages;
  return {
      "Random polyhedra",
      fmt::format("{}{}", family.name, seed),
      family.what,
      scene("kind = \"mesh\"\nfile = \"part.off\"",
            fmt::format("count = 30\nradius = {{ distribution = \"uniform\", min = {:.6g}, max = {:.6g} }}",
                        0.5 * radius, radius),
            stages),
      explained(1),
      {{"part.off", [mesh] { return test::as_off(mesh); }}}};
}

std::string objections(const Family& family, std::uint64_t first_seed, std::uint64_t seeds) {
  std::string all;
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    const Case c = case_of(family, seed);
    const auto walls = static_cast<WallArithmetic>(seed / 5 % 3);
    const std::string one = objection(c, end_of(c, walls));
    if (!one.empty()) all += fmt::format("{}, {}: {}\n", c.name, name_of(walls), one);
  }
  return all;
}

}  // namespace bernal::hard
