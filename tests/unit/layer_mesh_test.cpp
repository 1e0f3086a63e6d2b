// Meshes of spheres with layers, and of second order: volumes of layers, bridges and fluid in closed form,
// elements without folds, equal ends.
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/fill_layers.hpp"
#include "meshes/mesh_quality.hpp"
#include "meshes/second_order.hpp"
#include "process/find_program.hpp"
#include "solids/cut_out.hpp"
#include "solids/near_faces.hpp"

namespace bernal {
namespace layer_mesh_test {

constexpr double pi = std::numbers::pi;

double ball(double radius) { return 4 * pi / 3 * radius * radius * radius; }

#define NEEDS_TETGEN() \
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed"

InnerSpheres shells_in(const Spheres<dynamic>& spheres, const std::vector<double>& shares) {
  InnerSpheres shells{.first = {0}, .radius = {}};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (const double share : shares) shells.radius.push_back(share * spheres.r[i]);
    shells.first.push_back(shells.radius.size());
  }
  return shells;
}

/// One sphere in a periodic box, with its centre at these distances from the lower ends.
Solids one_at(const Vector<3>& center, const std::vector<double>& shares) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(center, 1);
  const Domain box = periodic_box(Vector<3>(2.6, 2.7, 2.8));
  Solids solids{
      .spheres = spheres, .domain = box, .pieces = pieces_of(spheres, box), .bridges = {}, .contacts = {}};
  solids.shells = shells_in(spheres, shares);
  return solids;
}

Spheres<dynamic> scattered(const Domain& box, double radius, int tries, unsigned seed) {
  std::mt19937 engine(seed);
  const Boundary<3> boundary = boundary_of<3>(box);
  Spheres<dynamic> spheres(3);
  for (int t = 0; t < tries; ++t) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) p[k] = std::uniform_real_distribution(0.0, boundary.edges[k])(engine);
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size() && is_free; ++j)
      is_free = boundary.minimum_image(p - spheres.center(j)).norm() > 2.04 * radius;
    if (is_free) spheres.push_back(p, radius);
  }
  return spheres;
}

/// Sums of volumes over regions, by layer; the fluid last.
std::vector<double> by_layer(const std::vector<MeshRegion>& regions, const std::vector<double>& volumes,
                             std::size_t layers) {
  std::vector<double> sums(layers + 1, 0.0);
  for (std::size_t r = 0; r < regions.size(); ++r) sums[r == 0 ? layers : *regions[r].layer] += volumes[r];
  return sums;
}

double stated(const std::vector<MeshRegion>& regions, std::uint32_t layer) {
  double sum = 0;
  for (const MeshRegion& region : regions)
    if (region.layer == layer) sum += *region.volume;
  return sum;
}

void expect_equal_ends(const VolumeMesh& mesh) {
  for (int axis = 0; axis < 3; ++axis) {
    ASSERT_FALSE(mesh.periodic[static_cast<std::size_t>(axis)].empty());
    for (const auto& [lower, upper] : mesh.periodic[static_cast<std::size_t>(axis)])
      for (int k = 0; k < 3; ++k)
        if (k != axis) {
          ASSERT_EQ(mesh.node(lower)[k], mesh.node(upper)[k]);
        }
  }
}

TEST(LayerMesh, RegionsHaveTheVolumesOfShells) {
  NEEDS_TETGEN();
  const Domain box = periodic_box(Vector<3>(5, 5.5, 6));
  const Spheres<dynamic> spheres = scattered(box, 1, 3000, 5);
  const std::vector<double> shares = {0.5, 0.9, 0.95};  // a thick layer between thin ones
  const Solids solids = solids_of(
      spheres, box, {.contact = ContactTreatment::gap, .gap = 0.01, .shells = shells_in(spheres, shares)});
  const auto count = static_cast<double>(spheres.size());
  ASSERT_GT(spheres.size(), 8u);
  const ConformingSurface surface = conforming_surface(solids, {.per_gap = 4, .solids = true});
  EXPECT_FALSE(surface.prisms.empty());
  FillReport report;
  VolumeMesh mesh = fill_with_layers(surface, {}, report);
  EXPECT_LT(report.volume_error, 1e-10);
  EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
  make_second_order(mesh);
  EXPECT_GT(least_curved_sicn(mesh), 0.05);
  expect_equal_ends(mesh);
  const std::vector<double> volumes = by_layer(mesh.regions, curved_volumes_of_regions(mesh), 4);
  const std::vector<double> wanted = {count * ball(0.5), count * (ball(0.9) - ball(0.5)),
                                      count * (ball(0.95) - ball(0.9)),
                                      count * (1 - std::pow(0.95, 3)) * ball(1)};
  for (std::uint32_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(stated(mesh.regions, k) / wanted[k], 1, 1e-12);
    EXPECT_NEAR(volumes[k] / wanted[k], 1, 3e-4) << "layer " << k;
  }
  EXPECT_NEAR(volumes[4] / *mesh.regions[0].volume, 1, 1e-4);
}

TEST(LayerMesh, EndsOfPeriodsCutLayersAtAnyDepth) {
  NEEDS_TETGEN();
  for (const double depth : {0.0, 0.4, 0.8, 0.88, 0.975}) {
    const Solids solids = one_at(Vector<3>(depth, 0.5 * depth, 1.4), {0.95});
    const ConformingSurface surface = conforming_surface(solids, {.solids = true});
    FillReport report;
    VolumeMesh mesh = fill_with_layers(surface, {}, report);
    EXPECT_GT(quality_of(mesh).least_sicn, 0.03) << depth;
    make_second_order(mesh);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
      ASSERT_GT(least_jacobian_coefficient(mesh, t), 0);
    const std::vector<double> volumes = by_layer(mesh.regions, curved_volumes_of_regions(mesh), 2);
    EXPECT_NEAR(volumes[0] / ball(0.95), 1, 1e-3) << depth;
    EXPECT_NEAR(volumes[1] / (ball(1) - ball(0.95)), 1, 2e-3) << depth;
  }
}

TEST(LayerMesh, ErrorsOfSecondOrderFallWithTheFourthPowerOfEdges) {
  NEEDS_TETGEN();
  double before = 0;
  for (const double edge : {0.4, 0.2}) {
    const ConformingSurface surface =
        conforming_surface(one_at(Vector<3>(1.3, 1.35, 1.4), {0.8}), {.sphere_edge = edge, .solids = true});
    FillReport report;
    VolumeMesh mesh = fill_with_layers(surface, {}, report);
    EXPECT_EQ(make_second_order(mesh).kept_straight, 0u);
    const double error =
        std::abs(by_layer(mesh.regions, curved_volumes_of_regions(mesh), 2)[0] / ball(0.8) - 1);
    if (before > 0) {
      EXPECT_GT(before / error, 8);
    }
    before = error;
  }
  EXPECT_LT(before, 2e-5);
}

TEST(NearFaces, NothingIsLeftThatABoxNearlyTouches) {
  const Bounds<3> box{.lower = Vector<3>(0, 0, 0), .upper = Vector<3>(4, 5, 6)};
  std::mt19937 engine(1);
  int smaller = 0;
  for (int n = 0; n < 20000; ++n) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) p[k] = std::uniform_real_distribution(0.0, box.upper[k])(engine);
    double radius = 1;
    std::array<double, 2> layers = {0.9, 0.95};
    smaller += NearFaces(box, p).clear(radius, layers, 0.01);
    EXPECT_LE(layers[0] / layers[1], 0.9 / 0.95 + 1e-12);
    EXPECT_LE(layers[1] / radius, 0.95 + 1e-12);
    // The nearest places of faces, edges and corners: each coordinate its own or moved to an end.
    for (const double r : {radius, layers[0], layers[1]})
      for (int which = 1; which < 27; ++which) {
        Vector<3> q = p;
        for (int k = 0, rest = which; k < 3; ++k, rest /= 3)
          if (rest % 3 > 0) q[k] = rest % 3 == 1 ? box.lower[k] : box.upper[k];
        const double beyond = (r - (q - p).norm()) / r;
        EXPECT_FALSE(-0.03 + 1e-12 < beyond && beyond < 0.06 - 1e-12) << p.transpose() << ": " << beyond;
      }
  }
  EXPECT_GT(smaller, 1000);
  double untouched = 1;
  EXPECT_FALSE(NearFaces(box, {2, 2.5, 3}).clear(untouched, {}, 0.01));
  EXPECT_EQ(untouched, 1);
}

TEST(NearFaces, EndsOfPeriodsLeaveNoLowCaps) {
  const Domain period = periodic_box(Vector<3>(5, 5.5, 6));
  const Spheres<dynamic> spheres = scattered(period, 0.3, 3000, 7);
  ASSERT_GT(spheres.size(), 200u);
  const Solids solids = solids_of(spheres, period,
                                  {.contact = ContactTreatment::gap,
                                   .gap = 0.01,
                                   .shells = shells_in(spheres, {0.9}),
                                   .clear_of_ends = true});
  EXPECT_GT(solids.cleared, 0u);
  EXPECT_LT(solids.cleared, spheres.size() / 3);
  for (const Piece& piece : solids.pieces)
    for (const Cut& cut : piece.cuts) {
      const double depth = cut.keeps.offset - cut.keeps.normal.dot(piece.center);
      EXPECT_GE(1 - depth / piece.radius, 0.06 - 1e-9);
    }
  double sum = 0;
  for (const double r : solids.spheres.r) sum += ball(r);
  EXPECT_NEAR(solids.contacts.volume_after, sum, 1e-9);
}

TEST(CutOut, BoxesHoldTheVolumesOfPartsOfBalls) {
  const ConvexPart box = part_of_box({.lower = Vector<3>(0, 0, 0), .upper = Vector<3>(2, 3, 4)});
  const auto volume_in_box = [&](const Vector<3>& center) { return volume_of(*piece_in(box, center, 0.5)); };
  EXPECT_NEAR(volume_in_box(Vector<3>(1, 1, 2)), ball(0.5), 1e-13);
  EXPECT_NEAR(volume_in_box(Vector<3>(0, 1, 2)), ball(0.5) / 2, 1e-13);
  EXPECT_NEAR(volume_in_box(Vector<3>(0, 3, 2)), ball(0.5) / 4, 1e-13);
  EXPECT_NEAR(volume_in_box(Vector<3>(-0.3, 1, 2)), cap_volume(0.5, 0.2), 1e-13);
  EXPECT_FALSE(piece_in(box, Vector<3>(-0.4, -0.4, 2), 0.5));
}

TEST(CutOut, FacesOfABoxCutSpheresAndLayers) {
  NEEDS_TETGEN();
  const Domain period = periodic_box(Vector<3>(5, 5.5, 6));
  const Spheres<dynamic> spheres = scattered(period, 1, 3000, 5);
  const Solids whole = solids_of(
      spheres, period, {.contact = ContactTreatment::gap, .gap = 0.01, .shells = shells_in(spheres, {0.9})});
  // More than a period along one axis.
  const CutOut part = cut_out(whole, part_of_box({Vector<3>(1, 1, 1), Vector<3>(7, 4, 4.5)}), 0.01);
  ASSERT_EQ(part.of_packing.size(), part.solids.spheres.size());
  EXPECT_GT(part.solids.spheres.size(), 8u);
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface = conforming_surface(part.solids, {.per_gap = 4, .solids = with_solids});
    FillReport report;
    VolumeMesh mesh = fill_with_layers(surface, {}, report);
    EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
    make_second_order(mesh);
    const std::vector<double> volumes = curved_volumes_of_regions(mesh);
    double stated_sum = 0, sum = 0;
    for (std::size_t r = 0; r < volumes.size(); ++r) {
      stated_sum += *mesh.regions[r].volume;
      sum += volumes[r];
      // Low caps end in edges too sharp for curves: they have some chords.
      EXPECT_NEAR(volumes[r], *mesh.regions[r].volume, 1e-2 * *mesh.regions[r].volume + 3e-3) << r;
    }
    if (!with_solids) continue;
    EXPECT_NEAR(volumes[0] / *mesh.regions[0].volume, 1, 2e-3);
    EXPECT_NEAR(sum, 6 * 3 * 3.5, 1e-9);
    EXPECT_NEAR(stated_sum, 6 * 3 * 3.5, 1e-9);
  }
}

TEST(CutOut, RefusesBoxesBeyondWallsAndBridges) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1, 1, 1), 1);
  const Domain box = Box{.size = Vector<3>(4, 4, 4)};
  const ConvexPart inside = part_of_box({Vector<3>(0, 0, 0), Vector<3>(1.2, 2, 4)});
  const ConvexPart beyond = part_of_box({Vector<3>(0, 0, 0), Vector<3>(1.2, 2, 5)});
  const auto solids = [&](ContactTreatment contact) {
    return solids_of(spheres, box, {.contact = contact, .gap = 0.01});
  };
  EXPECT_EQ(cut_out(solids(ContactTreatment::gap), inside, 0.01).solids.pieces.size(), 1u);
  EXPECT_THROW(cut_out(solids(ContactTreatment::gap), beyond, 0.01), Error);
  EXPECT_THROW(cut_out(solids(ContactTreatment::bridge), inside, 0.01), Error);
}

TEST(LayerMesh, BridgesLeaveInnerLayersWhole) {
  NEEDS_TETGEN();
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1.5, 1.5, 1.5), 1);
  spheres.push_back(Vector<3>(3.5, 1.5, 1.5), 1);
  const Domain box = Box{.size = Vector<3>(5, 3, 3)};
  const auto solids = [&](double share) {
    return solids_of(spheres, box,
                     {.contact = ContactTreatment::bridge,
                      .gap = 0.01,
                      .bridge_radius = 0.2,
                      .shells = shells_in(spheres, {share})});
  };
  EXPECT_THROW(conforming_surface(solids(0.98), {.solids = true}), Error);
  const ConformingSurface surface = conforming_surface(solids(0.9), {.solids = true});
  FillReport report;
  VolumeMesh mesh = fill_with_layers(surface, {}, report);
  EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
  make_second_order(mesh);
  const std::vector<double> volumes = curved_volumes_of_regions(mesh);
  for (std::size_t r = 0; r < volumes.size(); ++r)
    EXPECT_NEAR(volumes[r] / *mesh.regions[r].volume, 1, 5e-4) << r;
}

TEST(SecondOrder, RimsAndSidesOfBridgesAreRound) {
  NEEDS_TETGEN();
  Spheres<dynamic> spheres(3);
  for (const Vector<3>& c : {Vector<3>(1, 1, 1), Vector<3>(3, 1, 1), Vector<3>(2, 1 + std::sqrt(3.0), 1)})
    spheres.push_back(c, 1);
  const Cylinder cylinder{.radius = 1.9, .height = 3};
  Spheres<dynamic> in_cylinder(3);
  in_cylinder.push_back(Vector<3>(0.9, 0, 1), 1);
  const std::pair<Spheres<dynamic>, Domain> cases[] = {{spheres, Box{.size = Vector<3>(4, 4, 3)}},
                                                       {in_cylinder, cylinder}};
  for (const auto& [balls, domain] : cases)
    for (const bool with_solids : {false, true}) {
      const ConformingSurface surface =
          conforming_surface(solids_of(balls, domain, {.contact = ContactTreatment::bridge, .gap = 0.01}),
                             {.solids = with_solids});
      FillReport report;
      VolumeMesh mesh = fill_with_layers(surface, {}, report);
      const CurvedEdges edges = make_second_order(mesh);
      EXPECT_GT(edges.curved, 100u);
      EXPECT_LT(static_cast<double>(edges.kept_straight), 0.1 * static_cast<double>(edges.curved));
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const RoundSurface& shape = mesh.patches[mesh.patch[t]].shape;
        if (!shape.is_round() || edges.kept_straight > 0) continue;
        for (const std::uint32_t node : mesh.middles_of_triangle[t])
          ASSERT_NEAR(distance_from(shape, mesh.node(node)).distance, 0, 1e-11);
      }
      const std::vector<double> volumes = curved_volumes_of_regions(mesh);
      EXPECT_NEAR(volumes[0] / surface.statement.fluid_volume, 1, 2e-4);
      for (std::size_t r = 1; r < volumes.size(); ++r)
        EXPECT_NEAR(volumes[r] / *mesh.regions[r].volume, 1, 5e-3) << mesh.regions[r].group;
    }
}

TEST(SecondOrder, CoefficientsBoundTheJacobian) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> shift(-0.12, 0.12);
  VolumeMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.1, 1.2, 0}, {0, 0.2, 0.9}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.region = {0};
  mesh.regions = {{.group = "fluid"}};
  make_second_order(mesh);
  EXPECT_NEAR(least_jacobian_coefficient(mesh, 0), 6 * volumes_of_regions(mesh)[0], 1e-14);
  const std::vector<Vector<3>> straight = mesh.middles;
  for (int trial = 0; trial < 200; ++trial) {
    for (std::size_t k = 0; k < 6; ++k)
      mesh.middles[k] = straight[k] + Vector<3>(shift(engine), shift(engine), shift(engine));
    // The volume is the mean of the coefficients over six, and none of these is below the least.
    EXPECT_LE(least_jacobian_coefficient(mesh, 0), 6 * curved_volumes_of_regions(mesh)[0] + 1e-12);
    if (least_jacobian_coefficient(mesh, 0) > 0) {
      EXPECT_GT(curved_sicn(mesh, 0), 0);
    }
  }
  mesh.middles[0] = Vector<3>(0.5, 0.9, 0.4);  // through the opposite faces
  EXPECT_LT(least_jacobian_coefficient(mesh, 0), 0);
}

}  // namespace layer_mesh_test
}  // namespace bernal
