// Scenes whose spheres are to lie inside the surface of a CAD file itself.
#include <gtest/gtest.h>

#include <string>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "cad/read/polygon_soup.hpp"
#include "core/made.hpp"
#include "support/folder.hpp"
#include "support/plans.hpp"

namespace bernal {
namespace true_surface_scene_test {

class TrueSurfaceScene : public ::testing::Test {
 protected:
  void SetUp() override {
    if (cad::read_with_opencascade(std::string(meshes) + "frustum.brep", 1)
            .failure.find("without OpenCASCADE") != std::string::npos)
      GTEST_SKIP() << "built without OpenCASCADE";
  }

  static constexpr const char* meshes = BERNAL_DATA "/meshes/";

  static std::string scene(const std::string& file, const std::string& more, const std::string& radius) {
    return "unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"" + file + "\"\ntrue_surface = true\n" +
           more + "\n[spheres]\nradius = " + radius + "\ncount = 40\n";
  }

  static std::string refusal(const std::string& toml) {
    try {
      testing::plan_of(toml);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
};

// However coarse the triangles are: what they are off is kept from the walls.
TEST_F(TrueSurfaceScene, SpheresAreCertifiedInsideTheSurface) {
  for (const char* deflection : {"", "deflection = 0.05", "deflection = 0.5"}) {
    const Plan plan =
        testing::plan_of(scene(std::string(meshes) + "block_fillets_bore.step", deflection, "2.5"));
    const Packing packing = run(plan, {.seed = 1});
    EXPECT_EQ(packing.spheres.size(), 40U);
    const Certificate certificate = certify(packing.spheres, packing.domain);
    EXPECT_TRUE(certificate.certified) << certificate.statement;
    EXPECT_NE(certificate.statement.find("of the CAD surface by proven bounds"), std::string::npos);
    EXPECT_NE(certified_walls(packing.scene, packing.domain).find("the surface of the CAD file itself"),
              std::string::npos);
    if (*deflection == '\0') {
      EXPECT_LE(margin_of(packing.domain), 1e-3 * 2.5);
    }
  }
}

TEST_F(TrueSurfaceScene, WhatDoesNotGoWithItIsRefused) {
  const std::string block = std::string(meshes) + "block_fillets_bore.step";
  EXPECT_NE(
      refusal(scene(block, "obstacles = [{ kind = \"sphere\", radius = 2, center = [40, 20, 10] }]", "1"))
          .find("obstacles make other walls"),
      std::string::npos);
  EXPECT_NE(refusal(scene(block, "cap = \"z = 10\"", "1")).find("cap changes its walls"), std::string::npos);
  EXPECT_NE(refusal(scene(std::string(meshes) + "hopper.stl", "", "0.1")).find("holds triangles"),
            std::string::npos);
}

// A corner that is known to half a unit could let a sphere of that size out.
TEST_F(TrueSurfaceScene, AToleranceLargerThanASphereIsRefused) {
  std::string brep = testing::text_of(std::filesystem::path(meshes) / "frustum.brep");
  const std::string sharp = "\nVe\n1e-07\n";
  const std::size_t at = brep.find(sharp);
  ASSERT_NE(at, std::string::npos);
  brep.replace(at, sharp.size(), "\nVe\n0.5\n");
  const testing::Folder folder;
  const std::string file = folder.write("loose.brep", brep).string();
  const std::string said = refusal(scene(file, "", "0.4"));
  EXPECT_NE(said.find("loose.brep: face 1 (cone) has a corner at "), std::string::npos) << said;
  EXPECT_NE(said.find(", which the file knows to 0.5 only, no less than the smallest sphere's radius of 0.4; "
                      "export the part again with a finer tolerance, or take the key out"),
            std::string::npos)
      << said;
}

// In the process that reads the file, in the bounds and in the certificate; `tests/effects` asks the same of
// every other scene.
TEST_F(TrueSurfaceScene, NothingOfItIsMadeWhereNoSceneNamesIt) {
  const auto made_for = [](const std::string& toml) {
    const std::uint64_t before = made_so_far()["true surface"];
    const Plan plan = testing::plan_of(toml);
    Spheres<dynamic> one(3);
    one.push_back(Vector<3>(45, 20, 10), 1);
    certify(one, plan.domain);
    return made_so_far()["true surface"] - before;
  };
  const std::string block = std::string(meshes) + "block_fillets_bore.step";
  const std::string named = scene(block, "", "2.5");
  std::string unnamed = named;
  unnamed.replace(unnamed.find("true_surface = true"), 19, "");
  EXPECT_EQ(made_for(unnamed), 0U);
  EXPECT_GT(made_for(named), 1U);
  EXPECT_EQ(made_for("unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"" + std::string(meshes) +
                     "hopper.stl\"\n[spheres]\nradius = 0.1\ncount = 5\n"),
            0U);
}

}  // namespace true_surface_scene_test
}  // namespace bernal
