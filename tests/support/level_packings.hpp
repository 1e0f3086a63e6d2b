#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/export_packings.hpp"

// Packings with layers and with packings inside of their spheres, for programs of particle transport.
namespace bernal::testing::levels {

using exports::packing_in;

/// Without those that overlap one before them.
inline Packing apart(Packing packing) {
  const Spheres<dynamic> all = packing.spheres;
  const auto boundary = boundary_of<3>(packing.domain);
  packing.spheres = Spheres<dynamic>(3);
  Spheres<dynamic>& kept = packing.spheres;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool is_free = true;
    for (std::size_t j = 0; j < kept.size() && is_free; ++j) {
      Vector<3> d;
      for (std::size_t k = 0; k < 3; ++k) d[static_cast<int>(k)] = all.x[k][i] - kept.x[k][j];
      is_free = boundary.minimum_image(d).norm() > all.r[i] + kept.r[j];
    }
    if (!is_free) continue;
    for (std::size_t k = 0; k < 3; ++k) kept.x[k].push_back(all.x[k][i]);
    kept.r.push_back(all.r[i]);
  }
  EXPECT_GT(kept.size(), 10u);
  return packing;
}

inline Packing with_layers(Packing packing, const std::string& layers) {
  const Scene scene = parse_scene(
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 60\nradius = 0.2\n"
      "layers = " +
          layers,
      "");
  packing.scene.layers = scene.layers;
  return packing;
}

inline constexpr const char* three_layers =
    R"([{name = "kernel", share = 0.3}, {name = "buffer", material = "porous_carbon"}, {name = "SiC", thickness = 0.004}])";

inline double above_floor(const Vector<3>& p, const Cylinder& c) {
  const Vector<3> axis = c.axis.normalized(), q = p - c.base;
  const double along = q.dot(axis);
  return std::min({along, c.height - along, c.radius - (q - along * axis).norm()});
}
/// Of the box of `exports::periodic`.
inline double in_box(const Vector<3>& p) {
  return std::min(p.minCoeff(), (Vector<3>(3, 4, 5.3) - p).minCoeff());
}

/// Larger ones than those of `packing_in`.
inline Packing grown(Packing packing) {
  for (double& r : packing.spheres.r) r *= 1.9;
  return apart(std::move(packing));
}

inline Packing layered_cylinder(const Vector<3>& axis) {
  const Cylinder c{.base = {1, 2, -1}, .axis = axis, .radius = 2, .height = 5};
  Packing packing = grown(packing_in(c, "kind = \"cylinder\"\nradius = 2\nheight = 5"));
  Spheres<dynamic> within(3);  // growing took the others through the walls
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    if (above_floor(packing.spheres.center(i), c) < packing.spheres.r[i]) continue;
    for (std::size_t k = 0; k < 3; ++k) within.x[k].push_back(packing.spheres.x[k][i]);
    within.r.push_back(packing.spheres.r[i]);
  }
  packing.spheres = within;
  return with_layers(std::move(packing), three_layers);
}

/// Balls on a jittered grid within a ball, which a turn takes elsewhere.
inline Packing held(double radius, int along, double share, std::uint64_t seed) {
  Packing packing;
  packing.domain = Sphere{Vector<3>::Zero(), radius};
  packing.volume = volume_of(packing.domain);
  Random random(seed, stream(Stream::test, 2));
  packing.spheres = Spheres<dynamic>(3);
  const double step = 2 * radius / along, r = share * step;
  for (int i = 0; i < along * along * along; ++i) {
    Vector<3> p;
    for (int k = 0, n = i; k < 3; ++k, n /= along)
      p[k] = -radius + (n % along + 0.5) * step + (0.5 * step - r) * (2 * random.uniform() - 1);
    if (p.norm() + r >= radius) continue;
    for (std::size_t k = 0; k < 3; ++k) packing.spheres.x[k].push_back(p[static_cast<int>(k)]);
    packing.spheres.r.push_back(r);
  }
  packing.scene = parse_scene(
      fmt::format(
          "unit = \"um\"\n[container]\nkind = \"sphere\"\nradius = {}\n[spheres]\ncount = 1\nradius = 1\n",
          radius),
      "");
  return packing;
}

inline PackingsInside inside_of(const Packing& outer, std::vector<std::shared_ptr<const Packing>> templates,
                                std::uint64_t seed) {
  PackingsInside inside{.templates = std::move(templates)};
  Random random(seed, stream(Stream::test, 3));
  for (std::uint32_t i = 0; i < outer.spheres.size(); ++i) {
    if (i % 5 == 4) continue;  // some hold nothing
    inside.spheres.push_back(i);
    inside.which.push_back(i % static_cast<std::uint32_t>(inside.templates.size()));
    Eigen::Quaterniond turn(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5,
                            random.uniform() - 0.5);
    turn.normalize();
    inside.rotations.push_back({turn.w(), turn.x(), turn.y(), turn.z()});
  }
  return inside;
}

/// Three levels: spheres in a cylinder hold one of two packings, some of whose spheres hold another one.
inline Packing nested(bool with_third) {
  Packing core = packing_in(Cylinder{.base = {1, 2, -1}, .radius = 2, .height = 5},
                            "kind = \"cylinder\"\nradius = 2\nheight = 5\nbase = [1, 2, -1]");
  for (double& r : core.spheres.r) r = 0.2;
  core = with_layers(apart(core), R"([{name = "fuel", radius = 0.15}, {name = "graphite"}])");
  std::vector<std::shared_ptr<const Packing>> templates;
  for (const int along : {3, 6}) {
    Packing one = held(150, along, 0.4, 10 + static_cast<std::uint64_t>(along));
    one = with_layers(one, R"([{name = "kernel", share = 0.4}, {name = "coating"}])");
    if (with_third && along == 3) {
      const double ball = std::cbrt(0.4) * one.spheres.r[0];
      one.inside = {inside_of(one, {std::make_shared<Packing>(held(ball, 3, 0.45, 5))}, 6)};
    }
    templates.push_back(std::make_shared<Packing>(one));
  }
  core.inside = {inside_of(core, templates, 7)};
  return core;
}

/// The error's words hold these.
template <class Call>
void expect_refusal(const Call& call, const std::vector<std::string>& words) {
  try {
    call();
    ADD_FAILURE() << "accepted, where " << words.front() << " is expected";
  } catch (const Error& error) {
    const std::string said = error.what();
    EXPECT_EQ(said.find('\n'), said.npos) << said;
    for (const std::string& word : words) EXPECT_NE(said.find(word), said.npos) << word << " in " << said;
  }
}

}  // namespace bernal::testing::levels
