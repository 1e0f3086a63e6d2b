#include "meshes/volume_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "bernal/core/error.hpp"
#include "bernal/run/run.hpp"
#include "mesh_files/poly_mesh.hpp"
#include "meshes/fill.hpp"
#include "meshes/improve.hpp"
#include "meshes/mesh_quality.hpp"
#include "meshes/second_order.hpp"
#include "meshes/triangle_sides.hpp"
#include "process/find_program.hpp"
#include "support/plans.hpp"
#include "surfaces/icosphere.hpp"

namespace bernal::testing {
namespace volume_mesh_test {

using Kind = SurfacePatch::Kind;

void expect_sicn_by_condition(const std::array<Vector<3>, 4>& p) {
  // By its definition, with the inverse.
  Eigen::Matrix3d regular, edges;
  regular << 1, 0.5, 0.5, 0, std::sqrt(3.0) / 2, std::sqrt(3.0) / 6, 0, 0, std::sqrt(2.0 / 3);
  for (int k = 0; k < 3; ++k) edges.col(k) = p[static_cast<std::size_t>(k) + 1] - p[0];
  const Eigen::Matrix3d map = edges * regular.inverse();
  const double sign = map.determinant() > 0 ? 1 : -1;
  EXPECT_NEAR(sicn(p[0], p[1], p[2], p[3]), sign * 3 / (map.norm() * map.inverse().norm()), 1e-12);
}

TEST(MeshQuality, SicnIsTheInverseConditionNumber) {
  const std::array<Vector<3>, 4> corner = {Vector<3>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::array<Vector<3>, 4> regular = {Vector<3>{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  expect_sicn_by_condition(corner);
  expect_sicn_by_condition({Vector<3>{0.3, -2, 1}, {1, 0.2, 5}, {0, 1, 0.1}, {-3, 0, 1}});
  EXPECT_NEAR(std::abs(sicn(regular[0], regular[1], regular[2], regular[3])), 1, 1e-14);
  EXPECT_NEAR(sicn(corner[0], corner[1], corner[2], corner[3]),
              -sicn(corner[0], corner[2], corner[1], corner[3]), 1e-14);
}

TEST(MeshQuality, SliversAreNothing) {
  const double h = 1e-6;
  EXPECT_LT(std::abs(sicn({1, 0, h}, {-1, 0, h}, {0, 1, -h}, {0, -1, -h})), 1e-5);
  EXPECT_EQ(sicn({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}), 0);
}

TEST(MeshQuality, DihedralAnglesOfTheRegularTetrahedronAndOfACorner) {
  for (const double angle : dihedral_angles({1, 1, 1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, -1}))
    EXPECT_NEAR(angle, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-12);
  auto angles = dihedral_angles({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  std::ranges::sort(angles);
  const double flat = std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi;
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(angles[k], k < 3 ? flat : 90, 1e-12);
}

void add_ball(ConformingSurface& surface, const Vector<3>& center, double radius, std::uint32_t patch) {
  const Icosphere& ball = icosphere(4);
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const Vector<3>& v : ball.vertices) surface.vertices.push_back(center + radius * v);
  for (const FaceCorners& t : ball.triangles) {
    surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    surface.patch.push_back(patch);
  }
}

/// The unit cube with n squares a side along an edge, outwards; all but the last two axes of walls are one
/// patch, and those of x are ends of a period if asked for.
void add_cube(ConformingSurface& surface, std::uint32_t n, bool is_periodic) {
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> number;
  const auto vertex = [&](std::array<std::uint32_t, 3> at) {
    const auto [found, is_new] = number.try_emplace(at, static_cast<std::uint32_t>(surface.vertices.size()));
    if (is_new) surface.vertices.push_back(Vector<3>(at[0], at[1], at[2]) / n);
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const bool is_end = is_periodic && axis == 0;
      const auto patch = static_cast<std::uint32_t>(surface.patches.size());
      const auto face = static_cast<std::uint32_t>(2 * axis + upper);
      surface.patches.push_back({.kind = is_end ? Kind::period_end : Kind::wall,
                                 .index = face,
                                 .regions = {0, SurfacePatch::nothing}});
      for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
          std::array<std::uint32_t, 4> c{};
          for (std::uint32_t k = 0; k < 4; ++k) {
            std::array<std::uint32_t, 3> at{};
            at[axis] = upper ? n : 0;
            at[(axis + 1) % 3] = i + (k == 1 || k == 2);
            at[(axis + 2) % 3] = j + (k >= 2);
            c[k] = vertex(at);
          }
          for (const FaceCorners& t : {FaceCorners{c[0], c[1], c[2]}, FaceCorners{c[0], c[2], c[3]}}) {
            surface.triangles.push_back(upper ? t : FaceCorners{t[0], t[2], t[1]});
            surface.patch.push_back(patch);
          }
        }
    }
  if (!is_periodic) return;
  for (const auto& [at, lower] : number)
    if (at[0] == 0) surface.periodic[0].push_back({lower, number.at({n, at[1], at[2]})});
}

/// Two spheres in a unit cube. Their triangles point into the fluid.
struct TwoSpheres {
  ConformingSurface surface;
  Spheres<dynamic> spheres{3};
  Domain domain;

  explicit TwoSpheres(bool solids, bool is_periodic = false) {
    add_cube(surface, 6, is_periodic);
    surface.regions.push_back({.group = "fluid"});
    domain = Box{.corner = Vector<3>::Zero(), .size = Vector<3>::Ones()};
    const std::array<Vector<3>, 2> centers = {Vector<3>{0.3, 0.3, 0.3}, {0.65, 0.6, 0.7}};
    for (std::uint32_t i = 0; i < 2; ++i) {
      const double radius = 0.2 + 0.05 * i;
      spheres.push_back(centers[i], radius);
      if (solids) surface.regions.push_back({.group = "spheres", .sphere = i});
      surface.patches.push_back(
          {.kind = Kind::sphere,
           .index = i,
           .regions = {solids ? static_cast<int>(i) + 1 : -1, 0},
           .shape = {.kind = RoundSurface::Kind::sphere, .center = centers[i], .radius = radius}});
      add_ball(surface, centers[i], radius, static_cast<std::uint32_t>(surface.patches.size() - 1));
    }
  }
};

#define NEEDS_TETGEN() \
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed"

TEST(Fill, KeepsTheSurfaceAndTheVolumesOfRegions) {
  NEEDS_TETGEN();
  for (const bool solids : {false, true}) {
    const TwoSpheres two(solids);
    FillReport report;
    const VolumeMesh mesh = fill(two.surface, {}, report);
    EXPECT_LT(report.volume_error, 1e-12);
    EXPECT_GT(quality_of(mesh).least_sicn, 0.15);
    const std::vector<double> volumes = volumes_of_regions(mesh);
    double sum = 0;
    for (const double volume : volumes) sum += volume;
    if (solids)
      EXPECT_NEAR(sum, 1, 1e-12);
    else
      EXPECT_NEAR(sum, 1 - 4 * std::numbers::pi / 3 * (0.008 + 0.015625), 0.004);
    for (std::size_t v = 0; v < two.surface.vertices.size(); ++v)
      ASSERT_EQ(mesh.vertices[v], two.surface.vertices[v]);
  }
}

/// Of every tetrahedron: the faces that have nothing behind them.
std::vector<int> faces_outside(const VolumeMesh& mesh) {
  std::vector<int> count(mesh.tetrahedra.size(), 0);
  for (const auto& [behind, before] : sides_of_triangles(mesh))
    if (behind.is_there() != before.is_there())
      ++count[behind.is_there() ? behind.tetrahedron : before.tetrahedron];
  return count;
}

TEST(Fill, NoTetrahedronHasTwoFacesOnTheOutside) {
  NEEDS_TETGEN();
  const TwoSpheres two(false);
  FillReport report;
  // TetGen leaves some along the edges of the box.
  EXPECT_GT(std::ranges::max(faces_outside(fill(two.surface, {.goal = 0}, report))), 1);
  EXPECT_EQ(std::ranges::max(faces_outside(fill(two.surface, {.for_gradients = true}, report))), 1);
}

TEST(Fill, ASurfaceWithAHoleIsRefused) {
  NEEDS_TETGEN();
  TwoSpheres two(true);
  two.surface.triangles.pop_back();
  two.surface.patch.pop_back();
  FillReport report;
  EXPECT_THROW(fill(two.surface, {}, report), Error);
}

TEST(Fill, EndsWhenItIsToldTo) {
  NEEDS_TETGEN();
  const TwoSpheres two(false);
  FillReport report;
  const Monitor monitor{.on_progress = {}, .cancelled = [] { return true; }};
  EXPECT_THROW(fill(two.surface, {}, report, monitor), Cancelled);
}

TEST(Improve, RaisesTheLeastQualityAndKeepsVolumesAndTheSurface) {
  NEEDS_TETGEN();
  const TwoSpheres two(true);
  FillReport report;
  VolumeMesh mesh = fill(two.surface, {.goal = 0}, report);
  // Vertices inside are moved to where tetrahedra are poor, and not turned.
  std::vector<std::uint8_t> is_moved(mesh.vertices.size(), 0);
  for (const TetrahedronCorners& c : mesh.tetrahedra)
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t v = c[k], to = c[(k + 1) % 4];
      if (v < two.surface.vertices.size() || is_moved[v]) continue;
      is_moved[v] = 1;
      const Vector<3> before = mesh.vertices[v];
      mesh.vertices[v] = 0.2 * before + 0.8 * mesh.vertices[to];
      if (quality_of(mesh).least_sicn <= 0) mesh.vertices[v] = before;
    }
  const double before = quality_of(mesh).least_sicn;
  const std::vector<double> volumes = volumes_of_regions(mesh);
  const ImproveReport improved = improve(mesh);
  EXPECT_LT(before, 0.05);
  EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
  EXPECT_GT(improved.moved + improved.swapped, 0U);
  EXPECT_NO_THROW(sides_of_triangles(mesh));
  for (std::size_t r = 0; r < volumes.size(); ++r)
    EXPECT_NEAR(volumes_of_regions(mesh)[r], volumes[r], 1e-12);
}

TEST(SecondOrder, VolumesOfCurvedTetrahedraAreThoseOfSpheres) {
  NEEDS_TETGEN();
  const TwoSpheres two(true);
  FillReport report;
  VolumeMesh mesh = fill(two.surface, {}, report);
  const CurvedEdges edges = make_second_order(mesh);
  EXPECT_EQ(edges.curved, 2 * 480U);
  EXPECT_EQ(edges.kept_straight, 0U);
  EXPECT_GT(least_curved_sicn(mesh), 0.1);
  const std::vector<double> volumes = curved_volumes_of_regions(mesh);
  EXPECT_NEAR(volumes[0] + volumes[1] + volumes[2], 1, 1e-12);
  for (std::size_t i = 0; i < 2; ++i) {
    const double r = two.spheres.r[i], exact = 4 * std::numbers::pi / 3 * r * r * r;
    EXPECT_NEAR(volumes[i + 1] / exact, 1, 5e-4);
  }
}

TEST(MeshGroups, TellClassesOfSpheresByNamesThatFormatsTake) {
  const Packing packing =
      run(testing::plan_of("[container]\nkind = \"periodic\"\nedge = 4\n[spheres]\ncount = 6\nradius = { "
                           "distribution = \"classes\", "
                           "values = [0.3, 0.5, 0.4], shares = [1, 1, 1], basis = \"number\", names = [\"a "
                           "b\", \"steel\", \"a_b\"] }\n"));
  const ClassesOfMesh classes = classes_of_mesh(packing);
  EXPECT_EQ(classes.names, (std::vector<std::string>{"a_b", "steel", "a_b_2"}));
  VolumeMesh mesh;
  mesh.regions.push_back({.group = "fluid"});
  for (std::uint32_t i = 0; i < 6; ++i) {
    mesh.regions.push_back({.group = "spheres", .sphere = i});
    mesh.patches.push_back({.kind = SurfacePatch::Kind::sphere, .index = i});
  }
  const MeshGroups groups = groups_of(mesh, packing.domain, classes);
  EXPECT_EQ(groups.volumes.size(), 4u);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::string& name = classes.names[packing.classes[i]];
    EXPECT_EQ(groups.volumes[groups.volume_of_region[i + 1]], "spheres_" + name);
    EXPECT_EQ(groups.surfaces[groups.surface_of_patch[i]], "surface_of_" + name);
  }
  EXPECT_TRUE(classes_of_mesh(Packing()).names.empty());
}

TEST(PolyMesh, FacesAreInUpperTriangularOrderAndEndsAreImages) {
  NEEDS_TETGEN();
  const TwoSpheres two(true, true);
  FillReport report;
  const VolumeMesh mesh = fill(two.surface, {}, report);
  const MeshGroups groups = groups_of(mesh, two.domain);
  const PolyMesh poly = poly_mesh_of(mesh, groups);
  const std::size_t inner = poly.neighbour.size();
  std::set<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t f = 0; f < inner; ++f) {
    EXPECT_LT(poly.owner[f], poly.neighbour[f]);
    if (f > 0) {
      EXPECT_LT(std::pair(poly.owner[f - 1], poly.neighbour[f - 1]),
                std::pair(poly.owner[f], poly.neighbour[f]));
    }
    pairs.insert({poly.owner[f], poly.neighbour[f]});
  }
  EXPECT_EQ(pairs.size(), inner);
  EXPECT_EQ(4 * mesh.tetrahedra.size(), inner + poly.faces.size());
  // Every cell is closed: the areas of its faces, outwards, cancel out.
  std::vector<Vector<3>> sum(mesh.tetrahedra.size(), Vector<3>::Zero());
  for (std::size_t f = 0; f < poly.faces.size(); ++f) {
    const auto c = poly.faces[f];
    const Vector<3> area =
        (mesh.vertices[c[1]] - mesh.vertices[c[0]]).cross(mesh.vertices[c[2]] - mesh.vertices[c[0]]);
    sum[poly.owner[f]] += area;
    if (f < inner) sum[poly.neighbour[f]] -= area;
  }
  for (const Vector<3>& of_cell : sum) EXPECT_LT(of_cell.norm(), 1e-14);
  const auto patch_named = [&](const std::string& name) {
    return *std::ranges::find(poly.patches, name, [](const PolyMesh::Patch& patch) { return patch.name; });
  };
  const PolyMesh::Patch lower = patch_named("x_lower"), upper = patch_named("x_upper");
  ASSERT_EQ(lower.count, 72U);
  ASSERT_EQ(upper.count, 72U);
  EXPECT_EQ(lower.type, "cyclic");
  EXPECT_EQ(lower.neighbour, "x_upper");
  for (std::size_t k = 0; k < lower.count; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector<3> here = mesh.vertices[poly.faces[lower.first + k][i]];
      const Vector<3> there = mesh.vertices[poly.faces[upper.first + k][(3 - i) % 3]];
      EXPECT_EQ(Vector<3>(here + Vector<3>::UnitX()), there);
    }
  EXPECT_EQ(std::ranges::count(poly.patches, "surface_of_spheres",
                               [](const PolyMesh::Patch& patch) { return patch.name; }),
            0);
}

}  // namespace volume_mesh_test
}  // namespace bernal::testing
