// The surfaces that beds are meshed from: closed about every region, of the volume that is stated, without
// triangles that cross, the same at opposite ends.
#include "meshes/conforming_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bernal/core/error.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/changes.hpp"
#include "meshes/flat_walls.hpp"
#include "meshes/tetgen.hpp"
#include "meshes/volume_mesh.hpp"
#include "support/surface_oracle.hpp"

namespace bernal {
namespace conforming_surface_test {

TEST(ConformingSurface, OneBallInABox) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1.5, 1.4, 1.6), 1);
  const Solids solids = solids_in(spheres, Box{.size = Vector<3>(3, 3, 3)}, ContactTreatment::gap);
  double error_before = 0;
  for (const double edge : {0.3, 0.15}) {
    const ConformingSurface surface = conforming_surface(solids, {.sphere_edge = edge, .solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(euler_number(surface, 0), 4);  // two closed surfaces
    EXPECT_EQ(euler_number(surface, 1), 2);
    EXPECT_NEAR(surface.statement.fluid_volume, 27 - 4 * pi / 3, 1e-12);
    EXPECT_GT(surface.statement.least_angle, 25);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (surface.patches[surface.patch[t]].kind != SurfacePatch::Kind::sphere) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector<3>&a = surface.vertices[surface.triangles[t][k]],
              &b = surface.vertices[surface.triangles[t][(k + 1) % 3]];
        EXPECT_NEAR((a - Vector<3>(1.5, 1.4, 1.6)).norm(), 1, 1e-14);
        EXPECT_LT((a - b).norm(), 1.25 * edge);
      }
    }
    const double error = surface.statement.meshed_fluid_volume - surface.statement.fluid_volume;
    EXPECT_GT(error, 0);  // balls are inscribed
    if (error_before > 0) {
      EXPECT_NEAR(error_before / error, 4, 1);
    }
    error_before = error;
  }
}

TEST(ConformingSurface, NecksJoinBallsAndWalls) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface =
        conforming_surface(solids_in(touching(), box, ContactTreatment::bridge), {.solids = with_solids});
    expect_sound(surface, 0.02);
    // Six contacts, three with the floor, two with the wall y = 0, one with x = 0 and one with x = 4.
    ASSERT_EQ(surface.necks.size(), 13u);
    EXPECT_NEAR(surface.statement.contact_area, 13 * pi * 0.04, 1e-12);
    const double depth = std::sqrt(1 - 0.04), cap = cap_volume(1, 1 - depth);
    const double between = pi * 0.04 * (2 - 2 * depth) - 2 * cap, at_wall = pi * 0.04 * (1 - depth) - cap;
    EXPECT_NEAR(surface.statement.fluid_volume, 64 - 16 * pi / 3 - 6 * between - 7 * at_wall, 1e-9);
    EXPECT_GT(surface.statement.least_angle, 18);
    EXPECT_GT(surface.statement.least_angle_off_necks, 20);
    EXPECT_EQ(surface.statement.shrunk_necks, 0u);
    EXPECT_EQ(surface.regions.size(), with_solids ? 1u + 4 + 13 : 1u);
    // One closed surface with a handle for each neck but three, by which balls hang together with the walls.
    EXPECT_EQ(euler_number(surface, 0), 2 - 2 * (13 - 4));
    for (int region = 1; with_solids && region < 18; ++region) EXPECT_EQ(euler_number(surface, region), 2);
  }
}

TEST(ConformingSurface, CapsAndGapsLeaveRoom) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  for (const ContactTreatment contact :
       {ContactTreatment::gap, ContactTreatment::shrink, ContactTreatment::cap}) {
    const ConformingSurface surface =
        conforming_surface(solids_in(touching(), box, contact, 0.03), {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(euler_number(surface, 0), 2 + 4 * 2);
    EXPECT_GT(surface.statement.least_angle, 20);
  }
}

TEST(ConformingSurface, CylindersHaveRoundSides) {
  for (const bool is_periodic : {false, true}) {
    const Cylinder cylinder{.radius = 2, .height = 4, .periodic = is_periodic};
    Spheres<dynamic> spheres = scattered(cylinder, 0.5, 2000, 3);
    if (!is_periodic) {  // one that touches the side, one the floor
      spheres = Spheres<dynamic>(3);
      spheres.push_back(Vector<3>(1.5, 0, 2), 0.5);
      spheres.push_back(Vector<3>(0.1, 0.2, 0.5), 0.5);
    }
    const ConformingSurface surface = conforming_surface(
        solids_in(spheres, cylinder, is_periodic ? ContactTreatment::gap : ContactTreatment::bridge),
        {.solids = true});
    expect_sound(surface, 0.03);
    EXPECT_EQ(surface.necks.size(), is_periodic ? 0u : 2u);
  }
}

TEST(ConformingSurface, BallsInABall) {
  const Sphere container{.radius = 2};
  Spheres<dynamic> spheres(3);
  for (const Vector<3>& c : {Vector<3>(1.5, 0, 0), Vector<3>(0.5, 0, 0), Vector<3>(0, 0.2, -1.2)})
    spheres.push_back(c, 0.5);
  for (const ContactTreatment contact : {ContactTreatment::gap, ContactTreatment::bridge}) {
    const ConformingSurface surface =
        conforming_surface(solids_in(spheres, container, contact), {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(surface.necks.size(), contact == ContactTreatment::bridge ? 2u : 0u);
    EXPECT_EQ(euler_number(surface, 0), contact == ContactTreatment::bridge ? 4 : 8);
    EXPECT_GT(surface.statement.least_angle, 18);
  }
}

/// Volumes of all regions: what walls enclose.
double volume_of_regions(const ConformingSurface& surface) {
  double sum = 0;
  for (const double volume : volumes_between(surface)) sum += volume;
  return sum;
}

TEST(ConformingSurface, ABoxOfTrianglesIsABox) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  const Mesh mesh = mesh_of_box(bounds_of(box));
  for (const ContactTreatment contact :
       {ContactTreatment::bridge, ContactTreatment::gap, ContactTreatment::cap}) {
    const double gap = contact == ContactTreatment::bridge ? 0.01 : 0.03;
    const ConformingSurface wanted =
        conforming_surface(solids_in(touching(), box, contact, gap), {.solids = true});
    const ConformingSurface surface =
        conforming_surface(solids_in(touching(), mesh, contact, gap), {.solids = true});
    expect_sound(surface, 0.02);
    EXPECT_EQ(surface.necks.size(), wanted.necks.size());
    EXPECT_NEAR(surface.statement.fluid_volume, wanted.statement.fluid_volume, 1e-9);
    EXPECT_NEAR(surface.statement.contact_area, wanted.statement.contact_area, 1e-9);
    EXPECT_NEAR(volume_of_regions(surface), 64, 1e-11);
    EXPECT_GT(surface.statement.least_angle, 18);
    EXPECT_EQ(euler_number(surface, 0), euler_number(wanted, 0));
  }
}

TEST(ConformingSurface, CadPartsKeepTheirVolume) {
  // A drum of 24 flat sides with a bore, whose sides are narrow, and a block in it that touches nothing.
  const Revolved drum{.profile = {{0.4, 0}, {2.5, 0}, {2.5, 3}, {0.4, 3}}};
  Mesh part = surface_of(drum, 24);
  Mesh block = mesh_of_box({Vector<3>(1, -0.5, 0.2), Vector<3>(1.8, 0.4, 0.21)});
  turn_inside_out(block);
  append(part, block);
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(-1.2, 0.3, 0.5), 0.5);   // on the floor
  spheres.push_back(Vector<3>(-1.2, 0.3, 1.5), 0.5);   // on that
  spheres.push_back(Vector<3>(1.4, -0.1, 0.71), 0.5);  // on the block
  const double side = 2.5 * std::cos(pi / 24) - 0.5;   // at the middle of a side, and at an edge of the bore
  spheres.push_back(Vector<3>(side * std::cos(9 * pi / 24), side * std::sin(9 * pi / 24), 1.5), 0.5);
  spheres.push_back(Vector<3>(0, -0.9, 1.5), 0.5);
  for (const ContactTreatment contact : {ContactTreatment::bridge, ContactTreatment::gap}) {
    const SolidsInWalls made =
        solids_in_walls(spheres, part, {.contact = contact, .gap = 0.03, .bridge_radius = 0.2}, 0.15);
    const ConformingSurface surface = conforming_surface(made.solids, {.solids = true});
    expect_sound(surface, 0.02);
    // Triangles across the narrow sides of the bore are off them by at most 2 % of the radius.
    EXPECT_GT(surface.statement.wall_deviation, 0);
    EXPECT_LE(surface.statement.wall_deviation, 0.01);
    EXPECT_NEAR(volume_of_regions(surface), volume_of(Domain(part)),
                surface.statement.wall_deviation * 2 * pi * 0.4 * 3);
    EXPECT_GT(surface.statement.least_angle, 15);
    if (contact == ContactTreatment::bridge) {
      EXPECT_EQ(made.gaps_at_edges, 1u);
      EXPECT_EQ(surface.necks.size(), 4u);
    }
    // In the fluid alone, each ball and the block are holes.
    const ConformingSurface fluid = conforming_surface(made.solids, {});
    expect_sound(fluid, 0.02);
    const std::vector<Vector<3>> holes = points_of_holes(fluid);
    const auto in_block = [](const Vector<3>& p) {
      return p[0] > 1 && p[0] < 1.8 && p[1] > -0.5 && p[1] < 0.4 && p[2] > 0.2 && p[2] < 0.21;
    };
    EXPECT_TRUE(contact == ContactTreatment::bridge || std::ranges::any_of(holes, in_block));
  }
}

TEST(ConformingSurface, IsTheSameInAllThreads) {
  const Domain box = periodic_box(Vector<3>(3, 3, 3));
  const Solids solids = solids_in(scattered(box, 0.5, 500, 1), box, ContactTreatment::gap);
  const auto made_in = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return conforming_surface(solids, {});
  };
  const ConformingSurface one = made_in(1), other = made_in(3);
  EXPECT_EQ(one.triangles, other.triangles);
  EXPECT_EQ(one.vertices, other.vertices);
}

TEST(ConformingSurface, SpheresThroughWallsAreRefused) {
  for (const double x : {3.001, 3.5, 15.0}) {
    Spheres<dynamic> spheres(3);
    spheres.push_back(Vector<3>(x, 2, 2), 1);
    EXPECT_THROW(solids_in(spheres, Box{.size = Vector<3>(4, 4, 4)}, ContactTreatment::bridge), Error);
  }
}

TEST(ConformingSurface, OtherDomainsAreRefused) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0, 0, 0), 0.5);
  const Revolved drum{.profile = {{0, -2}, {2, -2}, {2, 2}, {0, 2}}};
  EXPECT_THROW(conforming_surface(solids_in(spheres, drum, ContactTreatment::none), {}), Error);
  const Solids solids = solids_in(spheres, Sphere{.radius = 2}, ContactTreatment::none);
  EXPECT_THROW(conforming_surface(solids, {.sphere_edge = 0}), Error);
}

}  // namespace conforming_surface_test
}  // namespace bernal
