#include "support/hopper.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "support/folder.hpp"

namespace bernal::testing {
namespace hopper_test {

// data/meshes/hopper.stl is made by this project: BERNAL_REGENERATE=1 ctest --preset release -R Hopper writes
// it.
TEST(Hopper, CommittedFileIsTheGeneratedOne) {
  const std::string file = BERNAL_DATA "/meshes/hopper.stl";
  const std::string generated = as_stl(hopper(), "hopper");
  if (std::getenv("BERNAL_REGENERATE")) std::ofstream(file, std::ios::binary) << generated;
  EXPECT_EQ(text_of(file), generated);
}

TEST(Hopper, IsClosedAndOrientedOutwards) {
  // Bin + frustum (prismatoid rule) + spout.
  const double volume =
      1.0 * 0.8 * 0.8 + 0.45 / 6 * (0.25 * 0.25 + 4 * 0.625 * 0.525 + 1.0 * 0.8) + 0.25 * 0.25 * 0.15;
  const Mesh mesh = hopper();
  EXPECT_NEAR(volume_of(mesh), volume, 1e-14);
  EXPECT_EQ(mesh.triangles.size(), 28u);
  for (const auto& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k) {  // every edge is used once each way
      const auto from = triangle[k], to = triangle[(k + 1) % 3];
      int same = 0, opposite = 0;
      for (const auto& other : mesh.triangles)
        for (int m = 0; m < 3; ++m) {
          same += other[m] == from && other[(m + 1) % 3] == to;
          opposite += other[m] == to && other[(m + 1) % 3] == from;
        }
      EXPECT_EQ(same, 1);
      EXPECT_EQ(opposite, 1);
    }
}

}  // namespace hopper_test
}  // namespace bernal::testing
