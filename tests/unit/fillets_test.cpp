// Bridges that touch what they join: their shape, the volume that is stated of them and the one that meshes
// hold, and surfaces with them.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "meshes/fill.hpp"
#include "meshes/neck_shape.hpp"
#include "meshes/second_order.hpp"
#include "meshes/surface_draft.hpp"
#include "meshes/tetgen.hpp"
#include "meshes/volume_mesh.hpp"
#include "process/find_program.hpp"
#include "support/surface_oracle.hpp"

namespace bernal {
namespace conforming_surface_test {

/// Spheres that touch, do not quite, and of other sizes; the same before walls.
std::vector<NeckEnds> ends_to_join() {
  return {{1, 1, 2},       {1, 1, 2.01}, {1, 0.4, 1.4},  {0.3, 1, 1.302},
          {1, 1e-2, 1.01}, {1, {}, 1},   {1, {}, 1.008}, {0.25, {}, 0.251}};
}

TEST(NeckShape, FilletsTouchSpheresAndWalls) {
  for (const NeckEnds& ends : ends_to_join())
    for (const double share : {0.05, 0.2, 0.6}) {
      const double r = ends.first, d = ends.distance, w = share * ends.least_radius();
      const NeckShape shape = fillet_between(ends, w);
      const double s = shape.spine(), t = shape.tube;
      ASSERT_GT(t, 0);
      // The tube's circle is as far from both spheres, or from the wall, as it is wide.
      EXPECT_NEAR(std::hypot(s, shape.waist), r + t, 1e-14 * d);
      EXPECT_NEAR(ends.second ? std::hypot(s, d - shape.waist) - *ends.second : d - shape.waist, t,
                  1e-14 * d);
      // It begins and ends on them.
      EXPECT_NEAR(std::hypot(shape.rims[0], shape.begin), r, 1e-14 * d);
      EXPECT_NEAR(ends.second ? std::hypot(shape.rims[1], d - shape.end) : shape.end, ends.second.value_or(d),
                  1e-14 * d);
      EXPECT_NEAR(shape.ring(0).radius, shape.rims[0], 1e-12 * d);
      EXPECT_NEAR(shape.ring(1).height, shape.end, 1e-12 * d);
      // Its volume, by the trapezoidal rule, and its least radius.
      constexpr int steps = 20000;
      double volume = 0, least = s;
      for (int k = 0; k < steps; ++k) {
        const NeckShape::Ring from = shape.ring(static_cast<double>(k) / steps),
                              to = shape.ring(static_cast<double>(k + 1) / steps);
        volume += 0.5 * pi * (from.radius * from.radius + to.radius * to.radius) * (to.height - from.height);
        least = std::min(least, from.radius);
      }
      EXPECT_NEAR(shape.volume() / volume, 1, 1e-6);
      EXPECT_NEAR(least, w, 1e-6 * w);
    }
}

TEST(NeckShape, RadiiFollowFromAnglesAndFromRims) {
  for (const NeckEnds& ends : ends_to_join())
    for (const bool is_fillet : {false, true}) {
      constexpr double degrees = 17;
      const double w = radius_for_angle(ends, degrees, is_fillet);
      const NeckShape shape = is_fillet ? fillet_between(ends, w) : cylinder_between(ends, w);
      const double larger = std::max(ends.first, ends.second.value_or(0));
      const double rim = ends.second && *ends.second > ends.first ? shape.rims[1] : shape.rims[0];
      if (w > 0.0501 * ends.least_radius() && w < 0.699 * ends.least_radius()) {
        EXPECT_NEAR(rim / larger, std::sin(degrees * pi / 180), 1e-12);
      }
      const double narrow = 0.5 * fillet_between(ends, w).rims[1];
      const double less = radius_for_rim(ends, 1, narrow, w);
      if (less > 0) {
        EXPECT_NEAR(fillet_between(ends, less).rims[1], narrow, 1e-9);
      }
      EXPECT_EQ(radius_for_rim(ends, 1, 3 * narrow, w), w);
    }
}

TEST(RoundSurface, TheDistanceFromATorusGrowsAlongItsDirection) {
  RoundSurface torus{.kind = RoundSurface::Kind::torus,
                     .center = Vector<3>(0.1, 0.2, 0.3),
                     .axis = Vector<3>(1, 2, 2) / 3,
                     .radius = 0.5,
                     .tube = 0.2};
  const Vector<3> u = torus.axis.unitOrthogonal(), v = torus.axis.cross(u);
  for (const int bent : {0, 1, 2}) {
    if (bent > 0)
      torus.bend = {.wall_radius = 2,
                    .across = bent == 1 ? u : Vector<3>(Vector<3>::Zero()),
                    .from = -0.18,
                    .height = 0.38};
    for (const double angle : {0.3, 1.9, 4.0})
      for (const double turn : {-1.0, 0.2, 1.4}) {
        const Vector<3> beside = (0.5 - 0.2 * std::cos(turn)) * (std::cos(angle) * u + std::sin(angle) * v);
        double height = 0.2 * std::sin(turn);
        if (bent > 0) {
          const double x = bent == 1 ? beside.dot(u) : beside.norm();
          height = -0.18 + (height + 0.18) * (1 - (2 - std::sqrt(4 - x * x)) / 0.38);
        }
        const Vector<3> p = torus.center + beside + height * torus.axis;
        const DistanceFrom on = distance_from(torus, p);
        EXPECT_NEAR(on.distance, 0, 1e-14);
        EXPECT_NEAR(on.direction.norm(), 1, 1e-14);
        constexpr double step = 1e-6;
        for (int k = 0; k < 3; ++k) {
          const double rise = distance_from(torus, p + step * Vector<3>::Unit(k)).distance -
                              distance_from(torus, p - step * Vector<3>::Unit(k)).distance;
          EXPECT_NEAR(rise / (2 * step), on.direction[k], 1e-8);
        }
        const auto back = point_on_all(std::array{torus}, p + 0.02 * on.direction);
        ASSERT_TRUE(back);
        EXPECT_NEAR(distance_from(torus, *back).distance, 0, 1e-12);
        EXPECT_NEAR((*back - p).norm(), 0, 2e-3);
      }
  }
}

Solids filleted(const Spheres<dynamic>& spheres, const Domain& domain, double radius = 0.2,
                double angle = 0) {
  return solids_of(spheres, domain,
                   {.contact = ContactTreatment::fillet, .bridge_radius = radius, .bridge_angle = angle});
}

TEST(Fillets, JoinBallsAndWalls) {
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface = conforming_surface(filleted(touching(), box), {.solids = with_solids});
    expect_sound(surface, 0.02);
    ASSERT_EQ(surface.necks.size(), 13u);
    EXPECT_NEAR(surface.statement.contact_area, 13 * pi * 0.04, 1e-12);
    EXPECT_GT(surface.statement.least_angle, 18);
    EXPECT_EQ(surface.statement.shrunk_necks, 0u);
    EXPECT_EQ(surface.statement.cut_fillets, 0u);
    EXPECT_EQ(euler_number(surface, 0), 2 - 2 * (13 - 4));
    for (int region = 1; with_solids && region < 18; ++region) EXPECT_EQ(euler_number(surface, region), 2);
  }
  // By angle: the same at all spheres.
  const Solids by_angle = filleted(touching(), box, 0.2, 20);
  for (const Circle& circle : [&] {
         SurfaceDraft draft(by_angle, {});
         add_necks(draft);
         std::vector<Circle> all;
         for (const DraftPiece& piece : draft.pieces)
           all.insert(all.end(), piece.circles.begin(), piece.circles.end());
         return all;
       }())
    EXPECT_NEAR(circle.radius, std::sin(20 * pi / 180), 1e-9);
}

/// The largest error of the volume of a bridge, over the volume.
double volume_error(const ConformingSurface& surface) {
  const std::vector<double> volumes = volumes_between(surface);
  double most = 0;
  for (std::size_t k = 0; k < volumes.size(); ++k)
    if (surface.regions[k].group == "bridges" && *surface.regions[k].volume > 0)
      most = std::max(most, std::abs(volumes[k] / *surface.regions[k].volume - 1));
  return most;
}

TEST(Fillets, VolumesConvergeWithTheSquareOfTheEdgeToThoseStated) {
  Spheres<dynamic> in_cylinder(3), in_ball(3);
  in_cylinder.push_back(Vector<3>(1.5, 0, 2), 0.5);
  in_cylinder.push_back(Vector<3>(0.1, 0.2, 0.5), 0.5);
  in_ball.push_back(Vector<3>(1.5, 0, 0), 0.5);
  in_ball.push_back(Vector<3>(0.5, 0, 0), 0.5);
  struct Bed {
    Spheres<dynamic> spheres;
    Domain domain;
    std::size_t necks;
  };
  for (const Bed& bed :
       {Bed{touching(), Box{.size = Vector<3>(4, 4, 4)}, 13},
        Bed{in_cylinder, Cylinder{.radius = 2, .height = 4}, 2}, Bed{in_ball, Sphere{.radius = 2}, 2}}) {
    for (const double edge : {0.12, 0.06, 0.03}) {
      const ConformingSurface surface =
          conforming_surface(filleted(bed.spheres, bed.domain, 0.4),
                             {.sphere_edge = 2 * edge, .neck_edge = edge, .solids = true});
      EXPECT_EQ(surface.necks.size(), bed.necks);
      EXPECT_EQ(open_edges(surface), 0u);
      // Chords along the tube add to what those around the axis take away.
      EXPECT_LT(volume_error(surface), 1.3 * edge * edge) << name_of(bed.domain) << " at " << edge;
    }
  }
}

TEST(Fillets, AreCylindersWhereEndsOfPeriodsWouldCutThem) {
  const Domain box = periodic_box(Vector<3>(3, 3.3, 3.6));
  Spheres<dynamic> spheres(3);  // a chain through the ends
  for (int k = 0; k < 3; ++k) spheres.push_back(Vector<3>(0.5 + k * 1.0, 1.4, 1.5), 0.5);
  spheres.push_back(Vector<3>(0.5, 1.4, 2.5), 0.5);
  spheres.push_back(Vector<3>(1.5, 1.4 + std::sqrt(0.75), 2.0), 0.5);
  const ConformingSurface surface = conforming_surface(filleted(spheres, box), {.solids = true});
  expect_sound(surface, 0.03);
  EXPECT_GE(surface.necks.size(), 4u);
  EXPECT_LT(surface.statement.cut_fillets, surface.necks.size());
}

TEST(Fillets, CurvedElementsHoldTheStatedVolumes) {
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed";
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1.5, 0, 0.5), 0.5);
  spheres.push_back(Vector<3>(0.5, 0, 0.5), 0.5);
  const ConformingSurface surface =
      conforming_surface(filleted(spheres, Cylinder{.radius = 2, .height = 1.6}, 0.3), {});
  ASSERT_EQ(surface.necks.size(), 4u);
  FillReport filled;
  VolumeMesh mesh = fill(surface, {}, filled);
  const CurvedEdges edges = make_second_order(mesh);
  // Of a tetrahedron with faces on both sides of a circle of contact edges stay straight.
  EXPECT_LT(static_cast<double>(edges.kept_straight), 0.15 * static_cast<double>(edges.curved));
  EXPECT_GT(least_curved_sicn(mesh), 0.1);
  EXPECT_NEAR(curved_volumes_of_regions(mesh).front() / surface.statement.fluid_volume, 1, 2e-5);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const RoundSurface& shape = mesh.patches[mesh.patch[t]].shape;
    if (shape.kind != RoundSurface::Kind::torus) continue;
    for (const std::uint32_t v : mesh.triangles[t])
      EXPECT_NEAR(distance_from(shape, mesh.vertices[v]).distance, 0, 1e-12);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<3>& middle = mesh.node(mesh.middles_of_triangle[t][k]);
      const Vector<3> straight =
          (mesh.vertices[mesh.triangles[t][k]] + mesh.vertices[mesh.triangles[t][(k + 1) % 3]]) / 2;
      if (middle != straight) {
        EXPECT_NEAR(distance_from(shape, middle).distance, 0, 1e-9);
      }
    }
  }
}

}  // namespace conforming_surface_test
}  // namespace bernal
