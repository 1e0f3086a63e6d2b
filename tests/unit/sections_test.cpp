// Meshes that are filled section by section: of the same surface and volumes as those filled at once.
#include "meshes/sections.hpp"

#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "geometry/edges.hpp"
#include "geometry/measures.hpp"
#include "meshes/fill.hpp"
#include "meshes/mesh_quality.hpp"
#include "meshes/triangle_sides.hpp"
#include "process/find_program.hpp"

namespace bernal {
namespace sections_test {

/// Balls of radius 0.45 over a square of 1.4, some of which nearly touch.
Spheres<dynamic> column_of_balls(double height, bool is_periodic) {
  std::mt19937 engine(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(engine);
  };
  Spheres<dynamic> spheres(3);
  const double out = is_periodic ? 0.7 : 0.2;
  for (double z = 0.5; z < height - 0.5; z += between(0.8, 1.0)) {
    const Vector<3> place{between(-out, out), between(-out, out), z};
    const auto overlaps = [&](std::size_t j) {
      Vector<3> apart = place - spheres.center(j);
      if (is_periodic)
        for (const int k : {0, 1}) apart[k] -= 1.4 * std::round(apart[k] / 1.4);
      return apart.norm() < 0.9;
    };
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size(); ++j) is_free = is_free && !overlaps(j);
    if (is_free) spheres.push_back(place, 0.45);
  }
  return spheres;
}

ConformingSurface surface_of(const Spheres<dynamic>& spheres, const Domain& domain, ContactTreatment contact,
                             bool solids) {
  const Solids made = solids_of(spheres, domain, {.contact = contact, .gap = 0.1, .bridge_radius = 0.3});
  return conforming_surface(made, {.sphere_edge = 0.5, .neck_edge = 0.3, .solids = solids});
}

ConformingSurface surface_in(const Domain& domain, ContactTreatment contact, bool solids) {
  return surface_of(column_of_balls(14, std::holds_alternative<Box>(domain)), domain, contact, solids);
}

const Domain in_cylinder = Cylinder{.radius = 0.8, .height = 14};
const Domain in_periodic_box =
    Box{.corner = Vector<3>{-0.7, -0.7, 0}, .size = Vector<3>{1.4, 1.4, 14}, .periodic = {true, true, true}};

TEST(Sections, AreOfOddCountAndNoThinnerThanTwoSpheres) {
  const ConformingSurface surface = surface_in(in_cylinder, ContactTreatment::bridge, false);
  const std::size_t triangles = surface.triangles.size();
  EXPECT_EQ(section_cuts(surface, triangles).count(), 1U);
  EXPECT_EQ(section_cuts(surface, triangles - 1).count(), 3U);
  EXPECT_EQ(section_cuts(surface, triangles / 4).count(), 5U);
  const SectionCuts cuts = section_cuts(surface, 1);
  EXPECT_EQ(cuts.axis, 2);
  EXPECT_EQ(cuts.count() % 2, 1U);
  for (std::size_t k = 1; k < cuts.at.size(); ++k) EXPECT_GT(cuts.at[k] - cuts.at[k - 1], 1.79);
}

/// The walls and ends of periods with the lids of a surface that has the fluid alone.
Mesh walls_with_lids(const ConformingSurface& surface) {
  Mesh closed;
  closed.vertices = surface.vertices;
  closed.vertices.insert(closed.vertices.end(), surface.lids.vertices.begin(), surface.lids.vertices.end());
  closed.triangles = surface.lids.triangles;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (const auto kind = surface.patches[surface.patch[t]].kind;
        kind == SurfacePatch::Kind::wall || kind == SurfacePatch::Kind::period_end)
      closed.triangles.push_back(surface.triangles[t]);
  return closed;
}

TEST(Sections, LidsCloseWallsWhereSpheresAndBridgesStand) {
  for (const ContactTreatment contact :
       {ContactTreatment::bridge, ContactTreatment::gap, ContactTreatment::cap}) {
    const ConformingSurface surface = surface_in(in_periodic_box, contact, false);
    const Mesh closed = walls_with_lids(surface);
    EXPECT_FALSE(surface.lids.triangles.empty());
    EXPECT_TRUE(open_edges(closed.triangles).empty());
    EXPECT_NEAR(signed_volume(closed), 1.4 * 1.4 * 14, 1e-9);
    EXPECT_TRUE(surface_in(in_periodic_box, contact, true).lids.triangles.empty());
  }
}

TEST(Sections, LidsCloseWallsUnderTheFeetOfBridges) {
  Spheres<dynamic> on_floor(3);
  on_floor.push_back(Vector<3>(0.1, 0, 0.46), 0.45);
  const ConformingSurface surface = surface_of(on_floor, in_cylinder, ContactTreatment::bridge, false);
  EXPECT_FALSE(surface.lids.triangles.empty());
  EXPECT_TRUE(open_edges(walls_with_lids(surface).triangles).empty());
}

/// Ends of periods cut bridges in the last one, some of which lead out of a section.
enum class Balls { bridged_in_cylinder, apart_in_box, bridged_in_box };
class FillInSections : public ::testing::TestWithParam<std::tuple<Balls, bool>> {};

TEST_P(FillInSections, KeepsTheSurfaceAndTheVolumes) {
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed";
  const auto [balls, solids] = GetParam();
  const bool are_bridged = balls != Balls::apart_in_box;
  const ConformingSurface surface =
      surface_in(balls == Balls::bridged_in_cylinder ? in_cylinder : in_periodic_box,
                 are_bridged ? ContactTreatment::bridge : ContactTreatment::gap, solids);
  ASSERT_NE(surface.necks.empty(), are_bridged);
  const TetrahedraOptions options{.most_triangles = surface.triangles.size() / 4};
  ASSERT_EQ(section_cuts(surface, options.most_triangles).count(), 5U);
  FillReport report, whole_report;
  const VolumeMesh mesh = fill(surface, options, report), whole = fill(surface, {}, whole_report);
  EXPECT_EQ(report.sections, 5U);
  EXPECT_FALSE(report.sections_failed);
  EXPECT_EQ(whole_report.sections, 1U);
  EXPECT_LT(report.volume_error, 1e-10);
  EXPECT_NO_THROW(sides_of_triangles(mesh));
  EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
  EXPECT_NEAR(static_cast<double>(mesh.tetrahedra.size()), static_cast<double>(whole.tetrahedra.size()),
              0.1 * static_cast<double>(whole.tetrahedra.size()));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  FillReport alone;
  const VolumeMesh again = fill(surface, options, alone);
  EXPECT_TRUE(mesh.vertices == again.vertices && mesh.tetrahedra == again.tetrahedra);
}

std::string name_of(const ::testing::TestParamInfo<std::tuple<Balls, bool>>& of) {
  constexpr std::array<const char*, 3> names = {"Cylinder", "PeriodicBox", "BridgesInPeriodicBox"};
  const auto [balls, solids] = of.param;
  return std::string(names[static_cast<std::size_t>(balls)]) + (solids ? "WithSolids" : "FluidAlone");
}

INSTANTIATE_TEST_SUITE_P(Beds, FillInSections,
                         ::testing::Combine(::testing::Values(Balls::bridged_in_cylinder, Balls::apart_in_box,
                                                              Balls::bridged_in_box),
                                            ::testing::Bool()),
                         name_of);

}  // namespace sections_test
}  // namespace bernal
