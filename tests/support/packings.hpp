#pragma once
#include <numbers>
#include <string>
#include <utility>

#include "bernal/core/random.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/scene/read_scene.hpp"

namespace bernal::testing {

/// Up to `n` disjoint spheres with radii between r_min and r_max, placed at random in the bounds, so that
/// what is near what can be decided by hand and by brute force. They stay r_max / 100 apart unless `touch`:
/// then every sphere grows until it touches, if its radius allows that.
inline Spheres<3> scattered(std::size_t n, double r_min, double r_max, const Bounds<3>& bounds,
                            std::uint64_t seed, bool touch = false) {
  Random random(seed, stream(Stream::test));
  Spheres<3> spheres;
  for (int failures = 0; spheres.size() < n && failures < 1000; ++failures) {
    const Vector<3> c = uniform_point(random, bounds);
    double room = std::min((c - bounds.lower).minCoeff(), (bounds.upper - c).minCoeff());
    for (std::size_t i = 0; i < spheres.size() && room > r_min; ++i) {
      room = std::min(room, (spheres.center(i) - c).norm() - spheres.r[i]);
    }
    if (!touch) room -= r_max / 100;
    const double drawn = random.uniform(r_min, r_max);
    const double r = touch ? std::min(room, r_max) : drawn;
    if (r > room || r < r_min) continue;
    spheres.push_back(c, r);
    failures = 0;
  }
  return spheres;
}

/// A packing as `run` would return it, for what reads packings and changes nothing.
inline Packing packing_of(Spheres<3> spheres, const Box& domain) {
  Packing packing;
  packing.spheres = std::move(spheres);
  packing.domain = domain;
  packing.volume = volume_of(packing.domain);
  packing.scene = parse_scene(
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10.0, 10.0, 10.0]\n"
      "[spheres]\nfill = true\nradius = { distribution = \"uniform\", min = 0.1, max = 2.0, "
      "basis = \"number\" }\n",
      "test.toml");
  packing.program.version = "0.0.0";
  packing.reason = "made by hand";
  return packing;
}

}  // namespace bernal::testing
