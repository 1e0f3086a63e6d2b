#include "hard/table/random_vessels.hpp"
#include "bernal/run/run.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "bernal/measure/rest.hpp"
#include "support/meshes.hpp"
#include "support/plain_check.hpp"
#include "support/plans.hpp"
#include "support/vessels.hpp"

namespace bernal::hard {
namespace {

std::size_t one_of(Random& random, std::size_t n) {
  return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
}

/// Bars across the vessel, from wall to wall but for a gap: their surface, inwards.
void add_bars(Mesh& vessel, double width, double height, Random& random) {
  const std::size_t n = 1 + one_of(random, 3);
  for (std::size_t k = 0; k < n; ++k) {
    const double thick = random.uniform(0.3, 0.8), z = height * (0.15 + 0.25 * static_cast<double>(k));
    const double turn = random.uniform(0, std::numbers::pi), half = random.uniform(0.3, 0.9) * width;
    Mesh bar = test::box_mesh(Vector<3>(-half, -thick, z), Vector<3>(2 * half, 2 * thick, 2 * thick));
    const auto first = test::index(vessel.vertices.size());
    for (const Vector<3>& v : bar.vertices)
      vessel.vertices.emplace_back(std::cos(turn) * v[0] - std::sin(turn) * v[1],
                                   std::sin(turn) * v[0] + std::cos(turn) * v[1], v[2]);
    for (const auto& [a, b, c] : bar.triangles) vessel.triangles.push_back({first + a, first + c, first + b});
  }
}

/// A profile of three to five rings, or a hopper's; turned about a leaning axis where that is asked.
Mesh vessel_of_triangles(Random& random, bool bars) {
  std::vector<test::Ring> profile = {{0, 0}};
  const auto corners = static_cast<std::uint32_t>(5 + one_of(random, 30));
  const std::size_t rings = 3 + one_of(random, 3);
  double z = 0, narrowest = 10;
  for (std::size_t k = 0; k < rings; ++k) {
    const double r = random.uniform(1.6, 4);
    narrowest = std::min(narrowest, r);
    profile.push_back({r, z, corners});
    z += random.uniform(1.5, 4);
  }
  z = profile.back().z;
  profile.push_back({0, z, 1});
  Mesh mesh = test::revolved(profile);
  if (bars) add_bars(mesh, 0.8 * narrowest, z, random);
  return mesh;
}

Domain vessel(Random& random, std::string& name) {
  const std::size_t kind = one_of(random, 6);
  const double width = random.uniform(1.2, 5), height = random.uniform(3, 14);
  Vector<3> axis(0, 0, 1);
  if (kind == 1) axis = uniform_direction<3>(random);
  name = std::vector<std::string>{"tin",  "leaning tin",         "box",
                                  "ball", "vessel of triangles", "vessel of triangles with bars"}[kind];
  if (kind < 2) return Cylinder{.base = Vector<3>::Zero(), .axis = axis, .radius = width, .height = height};
  if (kind == 2)
    return Box{.corner = Vector<3>(0, 0, 0), .size = Vector<3>(width, random.uniform(1.2, 5), height)};
  if (kind == 3) return Sphere{.center = Vector<3>(0, 0, 0), .radius = width};
  return vessel_of_triangles(random, kind == 5);
}

std::string sizes(Random& random) {
  switch (one_of(random, 4)) {
    case 0:
      return "1.0";
    case 1:
      return "{ distribution = \"uniform\", min = 0.5, max = 1.1 }";
    case 2:
      return "{ distribution = \"classes\", values = [1.0, 0.3], shares = [0.8, 0.2], basis = \"volume\" }";
    default:
      return "{ distribution = \"lognormal\", median = 0.6, sigma = 0.25, max = 1.1 }";
  }
}

std::string target(Random& random, bool has_floor) {
  const std::string counts[] = {"count = 1",  "count = 2",     "count = 3", "count = 17",
                                "count = 90", "count = 20000", ""};
  const std::size_t k = one_of(random, has_floor ? 9 : 7);
  if (k < 7) return counts[k];
  return k == 7 ? "height = 2.0" : "height = 2.6\ntop = \"heap\"\nheap_angle = 25";
}

std::string objection_to_bed(std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  std::string name;
  const Domain domain = vessel(random, name);
  const bool leans = random.uniform() < 0.3;
  const bool has_floor = !leans && (name == "tin" || name == "box");
  const Vector<3> down =
      leans ? Vector<3>(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -1) : Vector<3>(0, 0, -1);
  const std::string scene = fmt::format(
      "seed = {}\n[container]\nkind = \"box\"\nsize = [99, 99, 99]\n[spheres]\ndiameter = {}\n{}\n[[stage]]\n"
      "do = \"settle\"\ndirection = [{}, {}, -1]\n",
      seed, sizes(random), target(random, has_floor), down[0], down[1]);
  const Plan plan = testing::plan_of(scene, domain);
  const Packing packing = run(plan);
  const std::uint64_t unsettled = measure_rest(packing.spheres, packing.domain, down).unsettled;
  const std::string plain = testing::plain_objection(packing.spheres, packing.domain, 0);
  if (unsettled == 0 && plain.empty() && packing.outcome != Outcome::hit_limit && !packing.spheres.empty())
    return {};
  return fmt::format("{}: {} of {} not at rest; {}; {}\n{}\n", name, unsettled, packing.spheres.size(), plain,
                     packing.reason, scene);
}

}  // namespace

std::string objections_to_beds(std::uint64_t first_seed, std::uint64_t seeds) {
  std::string all;
  for (std::uint64_t k = 0; k < seeds; ++k) all += objection_to_bed(first_seed + k);
  return all;
}

}  // namespace bernal::hard
