// Prisms in the fluid on spheres and walls: where they stand, that they stay apart, that they and tetrahedra
// fill the fluid.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "mesh_files/poly_mesh.hpp"
#include "meshes/boundary_layer.hpp"
#include "meshes/mesh_quality.hpp"
#include "process/find_program.hpp"
#include "support/surface_oracle.hpp"

namespace bernal {
namespace prism_mesh_test {

using conforming_surface_test::crossings;
using conforming_surface_test::scattered;
using conforming_surface_test::solids_in;
using conforming_surface_test::touching;

#define NEEDS_TETGEN() \
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed"

double six_volumes(const std::vector<Vector<3>>& p, const TetrahedronCorners& c) {
  return (p[c[1]] - p[c[0]]).dot((p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[0]]));
}

TEST(Prisms, AreCutAlikeFromBothSidesAndKeepTheirVolume) {
  const std::vector<Vector<3>> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 2}, {0, 1, 1.5}};
  FaceCorners of_lower = {0, 1, 2};
  do {  // any numbers of the corners
    std::vector<Vector<3>> at(6);
    PrismCorners prism{};
    for (std::size_t k = 0; k < 3; ++k) {
      at[of_lower[k]] = p[k];
      at[of_lower[k] + 3] = p[k + 3];
      prism[k] = of_lower[k];
      prism[k + 3] = of_lower[k] + 3;
    }
    const auto cut = tetrahedra_of(prism);
    ASSERT_EQ(cut.size(), 3U);
    double sum = 0;
    for (const TetrahedronCorners& c : cut) {
      EXPECT_GT(six_volumes(at, c), 0);
      sum += six_volumes(at, c);
    }
    EXPECT_NEAR(sum, 4.5, 1e-14);  // half of the mean height, six times
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const bool has_diagonal = std::ranges::any_of(cut, [&](const TetrahedronCorners& c) {
          return std::ranges::count(c, prism[i]) == 1 && std::ranges::count(c, prism[j] + 3) == 1;
        });
        EXPECT_EQ(has_diagonal, prism[i] <= prism[j]);
      }
  } while (std::ranges::next_permutation(of_lower).found);
}

TEST(Prisms, WithCornersThatMeetArePyramidsAndTetrahedra) {
  const std::vector<Vector<3>> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  for (std::uint32_t k = 0; k < 3; ++k) {
    PrismCorners pyramid = {0, 1, 2, 3, 4, 5}, tetrahedron = {0, 1, 2, 0, 1, 2};
    pyramid[k + 3] = k;
    tetrahedron[k + 3] = k + 3;
    const auto of_pyramid = distinct_corners(pyramid), of_tetrahedron = distinct_corners(tetrahedron);
    ASSERT_EQ(of_pyramid.size(), 5U);
    EXPECT_EQ(of_pyramid[4], k);
    const Vector<3> square = (p[of_pyramid[2]] - p[of_pyramid[0]]).cross(p[of_pyramid[3]] - p[of_pyramid[1]]);
    EXPECT_GT(square.dot(p[k] - p[of_pyramid[0]]), 0);
    ASSERT_EQ(of_tetrahedron.size(), 4U);
    EXPECT_GT(six_volumes(p, {of_tetrahedron[0], of_tetrahedron[1], of_tetrahedron[2], of_tetrahedron[3]}),
              0);
    double sum = 0;
    for (const TetrahedronCorners& c : tetrahedra_of(pyramid)) sum += six_volumes(p, c);
    EXPECT_NEAR(sum, 2, 1e-14);
    EXPECT_EQ(tetrahedra_of(tetrahedron).size(), 1U);
  }
}

TEST(Prisms, LayersGrowByTheirRatio) {
  const std::vector<double> shares = shares_of_layers({.layers = 3, .growth = 2});
  ASSERT_EQ(shares.size(), 3U);
  EXPECT_NEAR(shares[0], 1.0 / 7, 1e-15);
  EXPECT_NEAR(shares[1], 3.0 / 7, 1e-15);
  EXPECT_EQ(shares[2], 1);
}

ConformingSurface raised_by(ConformingSurface surface, const std::vector<Vector<3>>& columns) {
  for (std::size_t v = 0; v < columns.size(); ++v) surface.vertices[v] += columns[v];
  return surface;
}

struct Bed {
  Spheres<dynamic> spheres;
  Domain domain;
  ContactTreatment contact;
};

std::vector<Bed> beds() {
  Spheres<dynamic> mixed(3);  // a small one over the middle of a large one's side, and one in between
  mixed.push_back(Vector<3>(2, 2, 2), 1.5);
  mixed.push_back(Vector<3>(2, 2, 3.8), 0.2);
  mixed.push_back(Vector<3>(3.4, 3.4, 3.4), 0.8);
  const Domain period = periodic_box(Vector<3>(3, 3.5, 4)), column = Cylinder{.radius = 2, .height = 4};
  return {{touching(), Box{.size = Vector<3>(4, 4, 5)}, ContactTreatment::bridge},
          {touching(), Box{.size = Vector<3>(4, 4, 5)}, ContactTreatment::cap},
          {mixed, Box{.size = Vector<3>(4.4, 4.4, 4.4)}, ContactTreatment::gap},
          {scattered(period, 0.5, 2000, 7), period, ContactTreatment::gap},
          {scattered(column, 0.5, 4000, 3), column, ContactTreatment::gap}};
}

TEST(PrismColumns, StayApartAndClearOfCircles) {
  for (const Bed& bed : beds())
    for (const double height : {0.05, 0.1, 0.3}) {
      const ConformingSurface surface =
          conforming_surface(solids_in(bed.spheres, bed.domain, bed.contact), {.per_gap = 4});
      const auto columns = prism_columns(surface, {.layers = 3, .height = height, .per_gap = 4});
      ASSERT_EQ(columns.size(), surface.vertices.size());
      EXPECT_EQ(crossings(raised_by(surface, columns)), 0U) << height;
      std::vector<std::set<std::uint32_t>> patches(columns.size());
      std::size_t standing = 0;
      for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
          patches[a].insert(surface.patch[t]);
          EXPECT_LE(columns[a].norm() - columns[b].norm(),
                    0.5 * (surface.vertices[a] - surface.vertices[b]).norm() + 1e-12);
        }
      for (std::size_t v = 0; v < columns.size(); ++v) {
        if (columns[v] == Vector<3>::Zero()) continue;
        ++standing;
        ASSERT_EQ(patches[v].size(), 1U);
        const SurfacePatch& on = surface.patches[*patches[v].begin()];
        ASSERT_TRUE(on.kind == SurfacePatch::Kind::sphere || on.kind == SurfacePatch::Kind::wall);
        if (on.kind != SurfacePatch::Kind::sphere) continue;
        EXPECT_LE(columns[v].norm(), height * on.shape.radius * (1 + 1e-12));
        const Vector<3> outwards = (surface.vertices[v] - on.shape.center).normalized();
        EXPECT_NEAR(columns[v].dot(outwards), columns[v].norm(), 1e-12);
      }
      if (height < 0.3) {
        EXPECT_GT(standing, columns.size() / 20);
      }
    }
}

TEST(PrismColumns, NoneStandWhereWallsAreInlets) {
  const Cylinder cylinder{.radius = 1.9, .height = 3};
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0, 0, 1.5), 0.5);
  const ConformingSurface surface =
      conforming_surface(solids_in(spheres, cylinder, ContactTreatment::gap), {});
  const auto columns = prism_columns(surface, {.layers = 2, .on_flat_walls = false});
  std::map<std::uint32_t, std::size_t> on_wall;  // by index of the wall
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (surface.patches[surface.patch[t]].kind == SurfacePatch::Kind::wall)
      for (const std::uint32_t v : surface.triangles[t])
        on_wall[surface.patches[surface.patch[t]].index] += columns[v] != Vector<3>::Zero();
  EXPECT_GT(on_wall[0], 0U);  // the side
  EXPECT_EQ(on_wall[1] + on_wall[2], 0U);
}

TEST(FillWithPrisms, ShellsStandOnFreeSpheres) {
  NEEDS_TETGEN();
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1.5, 1.5, 1.5), 1);
  const ConformingSurface surface =
      conforming_surface(solids_in(spheres, Box{.size = Vector<3>(3, 3, 3)}, ContactTreatment::gap), {});
  FillReport filled;
  PrismReport prisms;
  const VolumeMesh mesh = fill_with_prisms(surface, {.layers = 3, .height = 0.05, .on_flat_walls = false}, {},
                                           filled, prisms, {});
  EXPECT_EQ(prisms.covered, 1);
  EXPECT_EQ(prisms.ends, 0U);
  EXPECT_NEAR(prisms.least_height, 0.05, 1e-14);
  EXPECT_EQ(prisms.prisms, 3 * mesh.stacks.triangle.size());
  EXPECT_GT(prisms.least_scaled_jacobian, 0.5);
  double six = 0;
  for (const PrismCorners& prism : mesh.stacks.prisms)
    for (const TetrahedronCorners& c : tetrahedra_of(prism)) six += six_volumes(mesh.vertices, c);
  const double shell = 4 * std::numbers::pi / 3 * (std::pow(1.05, 3) - 1);
  EXPECT_NEAR(six / 6 / shell, 1, 0.03);  // chords
}

TEST(FillWithPrisms, FacesOfAllCellsCloseThem) {
  NEEDS_TETGEN();
  for (const Bed& bed : beds()) {
    const ConformingSurface surface =
        conforming_surface(solids_in(bed.spheres, bed.domain, bed.contact), {.per_gap = 4});
    FillReport filled;
    PrismReport prisms;
    const VolumeMesh mesh = fill_with_prisms(surface, {.layers = 3, .per_gap = 4}, {}, filled, prisms, {});
    EXPECT_GT(prisms.prisms, 0U);
    EXPECT_GT(prisms.covered, 0.1);
    EXPECT_LT(prisms.covered, 1);
    EXPECT_EQ(prisms.prisms + prisms.ends, mesh.stacks.prisms.size());
    EXPECT_GE(quality_of(mesh).least_sicn, 0.1);
    EXPECT_NEAR(volumes_of_regions(mesh)[0] / volumes_between(surface)[0], 1, 1e-10);
    const PolyMesh poly = poly_mesh_of(mesh, groups_of(mesh, bed.domain));
    ASSERT_EQ(poly.cells, mesh.tetrahedra.size() + mesh.stacks.prisms.size());
    std::vector<Vector<3>> sum(poly.cells, Vector<3>::Zero());
    std::vector<std::size_t> faces(poly.cells, 0);
    for (std::size_t f = 0; f < poly.faces.size(); ++f) {
      const auto c = poly.faces[f];
      Vector<3> area = Vector<3>::Zero();
      for (std::size_t k = 2; k < c.size(); ++k)
        area +=
            (mesh.vertices[c[k - 1]] - mesh.vertices[c[0]]).cross(mesh.vertices[c[k]] - mesh.vertices[c[0]]);
      sum[poly.owner[f]] += area;
      ++faces[poly.owner[f]];
      if (f >= poly.neighbour.size()) continue;
      ASSERT_LT(poly.owner[f], poly.neighbour[f]);
      if (f > 0) {
        ASSERT_LT(std::pair(poly.owner[f - 1], poly.neighbour[f - 1]),
                  std::pair(poly.owner[f], poly.neighbour[f]));
      }
      sum[poly.neighbour[f]] -= area;
      ++faces[poly.neighbour[f]];
    }
    for (std::size_t cell = 0; cell < poly.cells; ++cell) {
      ASSERT_LT(sum[cell].norm(), 1e-13);
      const std::size_t corners =
          cell < mesh.tetrahedra.size()
              ? 4
              : distinct_corners(mesh.stacks.prisms[cell - mesh.tetrahedra.size()]).size();
      ASSERT_EQ(faces[cell], corners == 4 ? 4U : 5U);
    }
  }
}

}  // namespace prism_mesh_test
}  // namespace bernal
