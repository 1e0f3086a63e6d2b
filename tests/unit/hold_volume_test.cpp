// Facets that hold the volumes of their spheres.
#include "meshes/hold_volume.hpp"

#include <gtest/gtest.h>

#include "support/surface_oracle.hpp"

namespace bernal {
namespace hold_volume_test {

using conforming_surface_test::pi;
using conforming_surface_test::scattered;
using conforming_surface_test::solids_in;
using conforming_surface_test::touching;

double volume_of(const PatchMesh& mesh) {
  double six = 0;
  for (const FaceCorners& t : mesh.triangles)
    six += mesh.added[t[0]].dot(mesh.added[t[1]].cross(mesh.added[t[2]]));
  return six / 6;
}

PatchMesh whole_sphere(double radius, double edge) {
  BoundedPart part{.surface = Delaunay::Surface::sphere, .extent = radius};
  for (const Vector<3>& corner : icosahedron()) part.starts.push_back(radius * corner);
  part.size = [=](const Vector<3>&) { return edge; };
  return mesh_patch(part);
}

TEST(HoldVolume, OfAWholeSphereIsThatOfTheSphere) {
  for (const double radius : {1e-3, 1.0, 40.0})
    for (const double edge : {0.9, 0.3, 0.1}) {
      PatchMesh mesh = whole_sphere(radius, edge * radius);
      const double exact = 4 * pi / 3 * radius * radius * radius, before = volume_of(mesh);
      EXPECT_LT(before, exact * (1 - 0.1 * edge * edge));
      hold_volume({}, mesh, radius, [=](const Vector<3>&) { return radius; });
      EXPECT_NEAR(volume_of(mesh) / exact, 1, 1e-12);
      for (const Vector<3>& p : mesh.added) {
        EXPECT_GT(p.norm(), radius);
        EXPECT_LT(p.norm(), radius * (1 + 0.2 * edge * edge));
      }
    }
}

TEST(HoldVolume, NoPointMovesByMoreThanAFifthOfItsRoom) {
  PatchMesh mesh = whole_sphere(1, 0.4);
  const std::vector<Vector<3>> before = mesh.added;
  const auto room = [](const Vector<3>& p) { return p[2] > 0 ? 0.01 : 1.0; };
  hold_volume({}, mesh, 1, room);
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_LE((mesh.added[k] - before[k]).norm(), 0.2 * room(before[k]) * (1 + 1e-12));
    EXPECT_NEAR(mesh.added[k].normalized().dot(before[k].normalized()), 1, 1e-14);
  }
  EXPECT_NEAR(volume_of(mesh), 4 * pi / 3, 1e-12);  // the lower half makes up for it
}

/// By how much the fluid between triangles is more than the stated one, over that.
double excess_of(const Solids& solids, SurfaceMeshOptions options, bool hold_volumes) {
  options.hold_volumes = hold_volumes;
  const ConformingSurface surface = conforming_surface(solids, options);
  conforming_surface_test::expect_sound(surface, 0.05);
  return surface.statement.meshed_fluid_volume / surface.statement.fluid_volume - 1;
}

TEST(HoldVolume, MakesThePorosityOfBedsThatOfTheirSpheres) {
  const Domain periodic = periodic_box(Vector<3>(6, 6, 6)), box = Box{.size = Vector<3>(4, 4, 4)};
  const Spheres<dynamic> many = scattered(periodic, 1, 4000, 7);
  ASSERT_GT(many.size(), 10u);
  for (const bool with_solids : {false, true})
    for (const auto& [spheres, domain, contact] : {std::tuple(many, periodic, ContactTreatment::gap),
                                                   std::tuple(many, periodic, ContactTreatment::bridge),
                                                   std::tuple(touching(), box, ContactTreatment::bridge),
                                                   std::tuple(touching(), box, ContactTreatment::cap)}) {
      const Solids solids = solids_in(spheres, domain, contact);
      const SurfaceMeshOptions options{.per_gap = 4, .solids = with_solids};
      const double inscribed = excess_of(solids, options, false), held = excess_of(solids, options, true);
      EXPECT_GT(inscribed, 0.003);
      EXPECT_LT(std::abs(held), 0.15 * inscribed) << name_of(domain) << static_cast<int>(contact);
    }
}

TEST(HoldVolume, LayersStayAsThickAsTheyAre) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1.5, 1.4, 1.6), 1);
  Solids solids = solids_in(spheres, Box{.size = Vector<3>(3, 3, 3)}, ContactTreatment::gap);
  solids.shells = {.first = {0, 1}, .radius = {0.95}};
  const ConformingSurface surface = conforming_surface(solids, {.solids = true, .hold_volumes = true});
  double outer = 0, inner = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const SurfacePatch& patch = surface.patches[surface.patch[t]];
    if (patch.shape.kind != RoundSurface::Kind::sphere) continue;
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) =
          surface.vertices[surface.triangles[t][static_cast<std::size_t>(k)]] - patch.shape.center;
    (patch.kind == SurfacePatch::Kind::sphere ? outer : inner) += corners.determinant() / 6;
  }
  EXPECT_NEAR(outer, 4 * pi / 3, 1e-11);
  EXPECT_NEAR(inner, 4 * pi / 3 * std::pow(0.95, 3), 1e-11);
}

}  // namespace hold_volume_test
}  // namespace bernal
