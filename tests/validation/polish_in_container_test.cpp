#include <gtest/gtest.h>

#include <string>

#include "bernal/measure/contacts.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/measured.hpp"
#include "support/plans.hpp"

// A cylinder and two CAD parts, each with about a thousand spheres: jammed at a gap of 1e-8, and within 1 %
// of isostatic at 1e-6, walls counted.
namespace bernal {
namespace polish_in_container_test {

void expect_jammed(const std::string& container, const std::string& spheres,
                   const std::string& stage = "do = \"relax\"\n") {
  const Packing packing = run(testing::plan_of("unit = \"mm\"\n[container]\n" + container + "[spheres]\n" +
                                               spheres + "[[stage]]\n" + stage + "polish = 1e-8\n"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  EXPECT_GT(packing.spheres.size(), 600u);
  for (const double gap : {1e-8, 1e-6}) {
    const Contacts contacts = measure_contacts(packing, gap);
    EXPECT_GT(contacts.backbone, 7 * packing.spheres.size() / 10) << gap;
    EXPECT_GT(contacts.backbone_walls, 100u) << gap;
    ASSERT_TRUE(contacts.isostatic.has_value()) << gap;
    const auto isostatic = static_cast<double>(*contacts.isostatic);
    EXPECT_NEAR(static_cast<double>(contacts.backbone_contacts()), isostatic, 0.01 * isostatic) << gap;
  }
}

std::string part(const std::string& name, const std::string& unit) {
  return "kind = \"mesh\"\nfile = \"" BERNAL_DATA "/meshes/" + name + "\"\nunit = \"" + unit + "\"\n";
}

TEST(PolishInContainer, CylinderAfterRelaxation) {
  expect_jammed("kind = \"cylinder\"\nradius = 5.0\nheight = 10.0\n", "radius = 0.5\n");
}

TEST(PolishInContainer, CylinderAfterGrowth) {
  expect_jammed("kind = \"cylinder\"\nradius = 5.0\nheight = 10.0\n", "radius = 0.5\n",
                "do = \"grow\"\nrate = 0.01\n");
}

TEST(PolishInContainer, Helix) {
  expect_jammed(part("lib3mf_helix.stl", "mm"),
                "diameter = { distribution = \"lognormal\", median = 4.0, sigma = 0.3, basis = \"number\", "
                "min = 1.6, max = 10.0 }\n");
}

TEST(PolishInContainer, Hopper) {
  expect_jammed(part("hopper.stl", "m"), "diameter = { distribution = \"uniform\", min = 60, max = 120 }\n");
}

}  // namespace polish_in_container_test
}  // namespace bernal
