// Meshes that are filled section by section: of the same surface and volumes as those filled at once.
#include "meshes/sections.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

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

ConformingSurface surface_in(const Domain& domain, ContactTreatment contact, bool solids) {
  const auto* box = std::get_if<Box>(&domain);
  const Spheres<dynamic> spheres = column_of_balls(14, box != nullptr);
  const Solids made = solids_of(spheres, domain, {.contact = contact, .gap = 0.1, .bridge_radius = 0.3});
  return conforming_surface(made, {.sphere_edge = 0.5, .neck_edge = 0.3, .solids = solids});
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

class FillInSections : public ::testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(FillInSections, KeepsTheSurfaceAndTheVolumes) {
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed";
  const auto [is_periodic, solids] = GetParam();
  const ConformingSurface surface = is_periodic ? surface_in(in_periodic_box, ContactTreatment::gap, solids)
                                                : surface_in(in_cylinder, ContactTreatment::bridge, solids);
  if (!is_periodic) {
    ASSERT_FALSE(surface.necks.empty());
  }
  const TetrahedraOptions options{.most_triangles = surface.triangles.size() / 4};
  ASSERT_EQ(section_cuts(surface, options.most_triangles).count(), 5U);
  FillReport report, whole_report;
  const VolumeMesh mesh = fill(surface, options, report), whole = fill(surface, {}, whole_report);
  EXPECT_EQ(report.sections, 5U);
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

INSTANTIATE_TEST_SUITE_P(Beds, FillInSections, ::testing::Combine(::testing::Bool(), ::testing::Bool()),
                         [](const auto& of) {
                           return std::string(std::get<0>(of.param) ? "PeriodicBox" : "Cylinder") +
                                  (std::get<1>(of.param) ? "WithSolids" : "FluidAlone");
                         });

}  // namespace sections_test
}  // namespace bernal
