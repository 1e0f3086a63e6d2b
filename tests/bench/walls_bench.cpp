#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/random.hpp"
#include "support/meshes.hpp"

// What a question to a mesh wall costs. The mesh is a rippled torus of extent 1 (tube of diameter 0.3) in
// triangles of nearly equal size. Each benchmark runs over spheres of three radii:
//
//   moderate   1.8 edges: some sixty triangles within 1.7 r, what a user meshes for
//   extent/50  a typical sphere of a packing, whatever the triangles
//   triangle   the length of a triangle's edge
//
// `near` spheres have a clearance of 1 to 1.2 r, `inside` ones stand anywhere they fit. Time per query is the
// time per iteration; queries come in random order, so that most of the tree is out of the near caches.
namespace bernal {
namespace {

constexpr double extent = 1.0;

struct Wall {
  Mesh mesh;
  std::unique_ptr<Container> plain, filtered, exact;
  double edge = 0;  ///< of a square of two triangles
};

const Wall& wall(std::int64_t triangles) {
  static std::map<std::int64_t, Wall> walls;
  Wall& w = walls[triangles];
  if (w.mesh.triangles.empty()) {
    const auto around =
        static_cast<std::uint32_t>(std::lround(std::sqrt(double(triangles) / 2 * 0.15 / 0.35)));
    const auto along = static_cast<std::uint32_t>(triangles / 2 / around);
    w.mesh = test::torus_mesh(0.35, 0.15, along, around, 0.03);
    const double resolution = std::numeric_limits<double>::epsilon();
    w.plain = make_mesh_container(w.mesh, WallArithmetic::plain, resolution);
    w.edge = std::sqrt(area_of(w.mesh) / double(triangles) * 2);
  }
  return w;
}

double radius_of(const benchmark::State& state, const Wall& w) {
  switch (state.range(1)) {
    case 0:
      return 1.8 * w.edge;
    case 1:
      return extent / 50;
    default:
      return w.edge;
  }
}

struct Query {
  Vector<3> center, direction;
};

Vector<3> unit_vector(Random& random) {
  for (;;) {
    const Vector<3> v =
        2 * Vector<3>(random.uniform(), random.uniform(), random.uniform()) - Vector<3>::Ones();
    if (v.squaredNorm() <= 1 && v.squaredNorm() > 0.01) return v.normalized();
  }
}

/// Centres whose clearance is between the given multiples of r.
std::vector<Query> queries(const Wall& w, double r, double least, double most) {
  Random random(1, 0);
  const Bounds<3> bounds = w.plain->bounds();
  std::vector<Query> result;
  while (result.size() < 4096) {
    // A point near the wall, moved inwards; random points alone would hardly ever be near.
    Vector<3> p;
    if (std::isfinite(most)) {
      const auto& t = w.mesh.triangles[random.uniform() * double(w.mesh.triangles.size())];
      p = w.mesh.vertices[t[0]];
      const Vector<3> normal = (w.mesh.vertices[t[1]] - p).cross(w.mesh.vertices[t[2]] - p).normalized();
      p -= (least + (most - least) * random.uniform()) * r * normal;
    } else {
      for (int k = 0; k < 3; ++k) p[k] = bounds.lower[k] + random.uniform() * bounds.size()[k];
    }
    const double clearance = w.plain->clearance(p);
    if (clearance >= least * r && clearance <= most * r) result.push_back({p, unit_vector(random)});
  }
  return result;
}

enum Place : std::int64_t { near_wall, anywhere };

template <typename Ask>
void run(benchmark::State& state, Ask ask) {
  const Wall& w = wall(state.range(0));
  const double r = radius_of(state, w);
  const bool is_near = state.range(2) == near_wall;
  const auto asked = queries(w, r, 1.0, is_near ? 1.2 : std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ask(w, asked[next], r));
    next = (next + 1) % asked.size();
  }
  std::vector<NearFacet> facets;
  std::size_t count = 0;
  for (const Query& q : asked) {
    facets.clear();
    w.plain->facets_near(q.center, 1.7 * r, facets);
    count += facets.size();
  }
  state.counters["within_1.7r"] = double(count) / double(asked.size());
}

/// Is a wall within r and a buffer of 0.2 r, and how far is it?
void bounded_distance(benchmark::State& state) {
  run(state,
      [](const Wall& w, const Query& q, double r) { return w.plain->clearance_within(q.center, 1.2 * r); });
}

/// How far may the sphere move in a random direction, at most 0.7 r?
void move_limit(benchmark::State& state) {
  run(state, [](const Wall& w, const Query& q, double r) {
    return w.plain->first_contact(q.center, r, q.direction, 0.7 * r);
  });
}

void every_wall(benchmark::internal::Benchmark* b) {
  b->ArgNames({"triangles", "radius", "place"});
  for (const std::int64_t triangles : {1'000, 10'000, 100'000, 1'000'000})
    for (const std::int64_t radius : {0, 1, 2})
      for (const Place place : {near_wall, anywhere})
        if (!(triangles == 1'000 && radius != 1)) b->Args({triangles, radius, place});
}

BENCHMARK(bounded_distance)->Apply(every_wall);
BENCHMARK(move_limit)->Apply(every_wall);

/// Does the sphere clear the wall: what each arithmetic costs, near the wall.
void contains(benchmark::State& state) {
  const auto arithmetic = static_cast<WallArithmetic>(state.range(3));
  const auto container = make_mesh_container(wall(state.range(0)).mesh, arithmetic, 0x1p-52);
  run(state, [&](const Wall&, const Query& q, double r) { return container->contains(q.center, r); });
  state.SetLabel(arithmetic == WallArithmetic::plain      ? "plain"
                 : arithmetic == WallArithmetic::filtered ? "filtered"
                                                          : "exact");
}
BENCHMARK(contains)
    ->ArgNames({"triangles", "radius", "place", "arithmetic"})
    ->ArgsProduct({{10'000, 100'000}, {0, 1}, {near_wall, anywhere}, {0, 1, 2}});

/// Does a sphere at a random point of the bounds clear the wall, as insertion asks?
void contains_trial(benchmark::State& state) {
  const Wall& w = wall(state.range(0));
  const auto container = make_mesh_container(w.mesh, WallArithmetic::filtered, 0x1p-52);
  const Bounds<3> bounds = container->bounds();
  Random random(2, 0);
  std::vector<Vector<3>> points(4096);
  for (Vector<3>& p : points)
    for (int k = 0; k < 3; ++k) p[k] = bounds.lower[k] + random.uniform() * bounds.size()[k];
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(container->contains(points[next], extent / 50));
    next = (next + 1) % points.size();
  }
}
BENCHMARK(contains_trial)->ArgName("triangles")->Arg(1'000)->Arg(100'000);

void build_container(benchmark::State& state) {
  const Mesh& mesh = wall(state.range(0)).mesh;
  for (auto _ : state) benchmark::DoNotOptimize(make_mesh_container(mesh, WallArithmetic::filtered, 0x1p-52));
}
BENCHMARK(build_container)
    ->ArgName("triangles")
    ->RangeMultiplier(10)
    ->Range(1'000, 1'000'000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace bernal
