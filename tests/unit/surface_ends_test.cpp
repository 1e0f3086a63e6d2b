// Surfaces of periodic beds, whose ends cut spheres, bridges and caps.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "meshes/surface_draft.hpp"
#include "support/surface_oracle.hpp"

namespace bernal {
namespace conforming_surface_test {

TEST(ConformingSurface, OppositeEndsAreTheSame) {
  for (const std::vector<bool>& walls : {std::vector<bool>{}, {true, false, false}, {true, true, false}}) {
    const Domain box = periodic_box(Vector<3>(3, 3.5, 4), walls);
    const Spheres<dynamic> spheres = scattered(box, 0.5, 2000, 7);
    ASSERT_GT(spheres.size(), 15u);
    for (const bool with_solids : {false, true})
      for (const ContactTreatment contact : {ContactTreatment::gap, ContactTreatment::cap}) {
        const ConformingSurface surface =
            conforming_surface(solids_in(spheres, box, contact, 0.03), {.solids = with_solids});
        expect_sound(surface, 0.03);
        for (std::size_t axis = 0; axis < 3; ++axis)
          EXPECT_EQ(surface.periodic[axis].empty(), !std::get<Box>(box).repeats(static_cast<int>(axis)));
      }
  }
}

/// Balls each of which touches one that is there already, in a random direction, and overlaps none.
Spheres<dynamic> clustered(const Domain& domain, double radius, int tries, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const Boundary<3> boundary = boundary_of<3>(domain);
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0.3, 0.4, 0.5), radius);
  for (int t = 0; t < tries; ++t) {
    const Vector<3> direction = Vector<3>(normal(engine), normal(engine), normal(engine)).normalized();
    const auto at = std::uniform_int_distribution<std::size_t>(0, spheres.size() - 1)(engine);
    const Vector<3> p = boundary.wrap(Vector<3>(spheres.center(at)) + 2.001 * radius * direction);
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size() && is_free; ++j)
      is_free = boundary.minimum_image(p - spheres.center(j)).norm() > 2.0005 * radius;
    if (is_free) spheres.push_back(p, radius);
  }
  return spheres;
}

TEST(ConformingSurface, EndsOfPeriodsCutBridges) {
  for (const std::vector<bool>& walls : {std::vector<bool>{}, {false, false, true}})
    for (const bool with_solids : {false, true}) {
      const Domain box = periodic_box(Vector<3>(3, 3.3, 3.6), walls);
      Spheres<dynamic> spheres = clustered(box, 0.5, 3000, with_solids ? 2 : 1);
      if (!walls.empty())  // none at the walls, and none through them
        spheres = [&] {
          Spheres<dynamic> inside(3);
          for (std::size_t i = 0; i < spheres.size(); ++i)
            if (spheres.x[2][i] > 0.55 && spheres.x[2][i] < 3.05)
              inside.push_back(Vector<3>(spheres.center(i)), 0.5);
          return inside;
        }();
      const Solids solids = solids_in(spheres, box, ContactTreatment::bridge);
      ASSERT_GT(solids.contacts.pairs, 10u);
      double error_before = 0;
      for (const double edge : {0.3, 0.15}) {
        const ConformingSurface surface = conforming_surface(
            solids, {.sphere_edge = edge, .neck_edge = 0.5 * edge, .per_gap = 4, .solids = with_solids});
        expect_sound(surface, 0.04);
        EXPECT_EQ(surface.necks.size(), solids.contacts.pairs);
        // Sides of necks reach ends of periods, and the same places of both.
        std::array<std::set<std::pair<double, double>>, 6> cut_at;
        const Boundary<3> boundary = boundary_of<3>(solids.domain);
        for (std::size_t t = 0; t < surface.triangles.size(); ++t)
          if (surface.patches[surface.patch[t]].kind == SurfacePatch::Kind::neck)
            for (const std::uint32_t c : surface.triangles[t])
              for (int k = 0; k < 3; ++k) {
                if (!boundary.repeats(k)) continue;
                const Vector<3>& p = surface.vertices[c];
                const std::pair at{p[(k + 1) % 3], p[(k + 2) % 3]};
                if (p[k] == boundary.origin[k]) cut_at[static_cast<std::size_t>(2 * k)].insert(at);
                if (p[k] == boundary.origin[k] + boundary.edges[k])
                  cut_at[static_cast<std::size_t>(2 * k + 1)].insert(at);
              }
        for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(cut_at[2 * axis], cut_at[2 * axis + 1]);
        EXPECT_GE(cut_at[0].size() + cut_at[2].size() + cut_at[4].size(), 4u);
        // Necks and balls have their volume, in closed form, within what chords cut off.
        double stated = 3 * 3.3 * 3.6;
        for (const double r : solids.spheres.r) stated -= 4 * pi / 3 * r * r * r;
        for (const MeshedNeck& neck : surface.necks) {
          const double a = neck.radius, depth = std::sqrt(0.25 - a * a);
          stated -= pi * a * a * (1.001 - 2 * depth) - 2 * cap_volume(0.5, 0.5 - depth);
        }
        EXPECT_NEAR(surface.statement.fluid_volume, stated, 0.002);
        const double error = surface.statement.meshed_fluid_volume - surface.statement.fluid_volume;
        EXPECT_GT(error, 0);
        if (error_before > 0) {
          EXPECT_NEAR(error_before / error, 4, 1);
        }
        error_before = error;
      }
    }
}

/// The area of the side of a bridge of radius 0.1 about the z axis, unrolled, all of whose triangles face
/// outwards.
double unrolled_area(const ConformingSurface& surface) {
  double area = 0;
  for (const FaceCorners& t : surface.triangles) {
    std::array<Vector<3>, 3> flat;
    double before = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<3>& p = surface.vertices[t[k]];
      const double angle = std::atan2(p[1], p[0]);
      before = k == 0 ? angle : before + std::remainder(angle - before, 2 * pi);
      flat[k] = Vector<3>(0.1 * before, p[2], 0);
    }
    const double part = 0.5 * (flat[1] - flat[0]).cross(flat[2] - flat[0])[2];
    EXPECT_GT(part, 0) << "normals point into the fluid";
    area += part;
  }
  return area;
}

Solids one_ball() {
  Spheres<dynamic> one(3);
  one.push_back(Vector<3>(1, 1, 1), 0.5);
  return solids_in(one, periodic_box(Vector<3>(2, 2, 2)), ContactTreatment::bridge);
}
/// Of radius 0.1, about the z axis.
DraftNeck cut_bridge(double height) {
  DraftNeck neck;
  static_cast<NeckShape&>(neck) = {.radius = 0.1, .end = height, .rims = {0.1, 0.1}};
  neck.is_cut = true;
  neck.edge = 0.12;
  return neck;
}

/// An end nearly square to a bridge leaves a thin part of its side, along whose boundary chords are as far
/// from the cylinder as the boundary's two sides are from each other.
TEST(ConformingSurface, ThinSidesOfBridgesAreMeshed) {
  const Solids solids = one_ball();
  const SurfaceMeshOptions options;
  for (const double first : {0.0, 2.0, 5.0})  // where it begins around the axis
    for (const double height : {0.02, 0.004, 0.0004}) {
      SurfaceDraft draft(solids, options);
      DraftNeck neck = cut_bridge(height);
      NeckTrace boundary{.is_closed = true};
      double area = 0, x_before = 0, y_before = 0;  // of the boundary, unrolled
      const auto add = [&](double angle, double along) {
        boundary.ids.push_back(draft.add_vertex(
            Vector<3>(0.1 * std::cos(first + angle), 0.1 * std::sin(first + angle), along), neck.edge));
        area += 0.5 * (x_before * along - 0.1 * angle * y_before);
        x_before = 0.1 * angle;
        y_before = along;
      };
      for (const double angle : {0.0, 0.64, 1.28, 1.92, 2.56, 3.2}) add(angle, 0);
      for (const double angle : {2.2, 1.6, 1.0}) add(angle, height);
      neck.traces = {boundary};
      draft.necks = {neck};
      mesh_necks(draft);
      ASSERT_GE(draft.made.triangles.size(), 7u);
      EXPECT_NEAR(unrolled_area(draft.made), std::abs(area), 1e-9 * std::abs(area));
    }
}

/// The same where the boundary goes all the way around on both sides: edges of a circle are chords of it.
TEST(ConformingSurface, ThinSidesOfBridgesAreMeshedAllAround) {
  const Solids solids = one_ball();
  const SurfaceMeshOptions options;
  for (const double first : {0.0, 0.1, 0.35})  // by which the upper points are turned
    for (const double height : {0.02, 0.004, 0.0008}) {
      SurfaceDraft draft(solids, options);
      DraftNeck neck = cut_bridge(2 * height);
      double area = 0;
      for (const bool is_upper : {false, true}) {
        const int count = is_upper ? 8 : 9;
        NeckTrace boundary{.is_closed = true};
        double sum = 0;
        for (int k = 0; k < count; ++k) {
          const double angle = 2 * pi * k / count + (is_upper ? first : 0);
          const double along = is_upper ? height * (1 + 0.5 * std::cos(angle)) : 0;
          boundary.ids.push_back(
              draft.add_vertex(Vector<3>(0.1 * std::cos(angle), 0.1 * std::sin(angle), along), neck.edge));
          sum += along;
        }
        area += 2 * pi * 0.1 * sum / count;
        neck.traces.push_back(boundary);
      }
      draft.necks = {neck};
      mesh_necks(draft);
      ASSERT_GE(draft.made.triangles.size(), 17u);
      EXPECT_NEAR(unrolled_area(draft.made), area, 1e-9 * area);
    }
}

/// What caps have, by their flat faces: of each sphere those of different depth or direction.
double volume_of_caps(const ConformingSurface& surface, const Solids& solids) {
  const Boundary<3> boundary = boundary_of<3>(solids.domain);
  std::map<std::array<long, 5>, double> of_cap;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const SurfacePatch& patch = surface.patches[surface.patch[t]];
    if (patch.kind != SurfacePatch::Kind::cut_face) continue;
    const auto corner = [&](std::size_t k) { return surface.vertices[surface.triangles[t][k]]; };
    const Vector<3> normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
    const double r = solids.spheres.r[patch.index];
    const double depth = normal.dot(boundary.minimum_image(corner(0) - solids.spheres.center(patch.index)));
    const auto rounded = [](double x) { return std::lround(x * 1e4); };
    of_cap[{patch.index, rounded(depth), rounded(normal[0]), rounded(normal[1]), rounded(normal[2])}] =
        cap_volume(r, r - depth);
  }
  double sum = 0;
  for (const auto& [cap, volume] : of_cap) sum += volume;
  return sum;
}

TEST(ConformingSurface, CapsAreDeeperWhereEndsWouldNearlyTouchThem) {
  const Domain box = periodic_box(Vector<3>(3, 3.3, 3.6));
  const Solids solids = solids_in(clustered(box, 0.5, 3000, 1), box, ContactTreatment::cap);
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface = conforming_surface(solids, {.per_gap = 4, .solids = with_solids});
    expect_sound(surface, 0.04);
    EXPECT_GT(surface.statement.deepened_caps, 0u);
    EXPECT_LT(surface.statement.deepened_caps, solids.contacts.pairs);
    EXPECT_GT(surface.statement.contact_area, solids.contacts.contact_area);
    EXPECT_NEAR(surface.statement.fluid_volume,
                3 * 3.3 * 3.6 - volume_of_balls(solids.spheres) + volume_of_caps(surface, solids), 1e-6);
  }
}

TEST(ConformingSurface, EndsOfPeriodsGoPastBridgesOnWalls) {
  const Cylinder cylinder{.radius = 2, .height = 4, .periodic = true};
  Spheres<dynamic> spheres(3);  // a spiral at the side, whose first ball is at the end of the period
  for (int k = 0; k < 8; ++k) {
    const double angle = 2 * pi * k / 8;
    spheres.push_back(Vector<3>(1.5 * std::cos(angle), 1.5 * std::sin(angle), 0.45 * k), 0.5);
  }
  const Solids solids = solids_in(spheres, cylinder, ContactTreatment::bridge);
  const Boundary<3> boundary = boundary_of<3>(solids.domain);
  for (const double z : solids.spheres.x[2]) {
    const double from = (z - boundary.origin[2]) / 4;
    EXPECT_GT(4 * std::abs(from - std::nearbyint(from)), 0.1);
  }
  const ConformingSurface surface = conforming_surface(solids, {.solids = true});
  expect_sound(surface, 0.03);
  EXPECT_EQ(std::ranges::count_if(surface.necks, [](const MeshedNeck& neck) { return !neck.other; }), 8);
}

}  // namespace conforming_surface_test
}  // namespace bernal
