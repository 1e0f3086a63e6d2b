#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "bernal/measure/measure.hpp"
#include "support/tilted_cells.hpp"

namespace bernal {
namespace tilted_measurements_test {

using testing::tilted::Cell;
using testing::tilted::random_spheres;

/// Measurements of pairs, as whole edges of tilt do not change what is near what.
TEST(TiltedBox, ByWholeEdgesMeasuresAsTheUprightBox) {
  const Cell upright{{1, 1, 1}, {0, 0, 0}, 2}, tilted{{1, 1, 1}, {1, -2, 1}, 2};
  const Spheres<dynamic> s(random_spheres(upright, 200, 0.05, 0.07, 13));
  const Measurements a = measure(s, upright.box()), b = measure(s, tilted.box());
  EXPECT_EQ(a.contacts.pairs, b.contacts.pairs);
  EXPECT_EQ(a.contacts.rattlers, b.contacts.rattlers);
  ASSERT_TRUE(a.radial && b.radial);
  EXPECT_EQ(a.radial->g, b.radial->g);
  EXPECT_NEAR(a.order->mean_q6, b.order->mean_q6, 1e-6);
  ASSERT_TRUE(a.structure && b.structure);
  for (std::size_t k = 0; k < 10; ++k) {  // all wave vectors of these bins, in another order
    EXPECT_EQ(a.structure->vectors[k], b.structure->vectors[k]);
    EXPECT_NEAR(a.structure->s[k], b.structure->s[k], 1e-9 * (1 + a.structure->s[k]));
  }
  EXPECT_TRUE(a.left_out.empty());
  EXPECT_EQ(b.left_out.size(), 2u);
}

/// S(k) of a crystal in its primitive cell has the peaks of the crystal.
TEST(TiltedBox, StructureFactorKnowsTheReciprocalVectors) {
  const double r = 0.5, edge = 1;
  const Cell cell{{edge, edge * std::sqrt(0.75), edge * std::sqrt(2.0 / 3)},
                  {edge / 2, edge / 2, edge * std::sqrt(1.0 / 12)},
                  1};
  // Twice the primitive cell along each vector: S is 8 at the wave vectors of the crystal, else 0.
  const Cell twice{2 * cell.edges, scaled(cell.tilt, 2), 1};
  Spheres<dynamic> s(3);
  for (int k = 0; k < 8; ++k) s.push_back(cell.at(k & 1, k >> 1 & 1, k >> 2), r);
  const Measurements m = measure(s, twice.box());
  ASSERT_TRUE(m.structure);
  // The first peak, of the planes (111), sqrt(2/3) apart.
  const double first = 2 * std::numbers::pi / std::sqrt(2.0 / 3);
  for (std::size_t b = 0; b < m.structure->k.size(); ++b) {
    if (m.structure->k[b] < first - 0.1) {
      EXPECT_NEAR(m.structure->s[b], 0, 1e-9);
    }
    if (std::abs(m.structure->k[b] - first) < 1e-6) {
      EXPECT_NEAR(m.structure->s[b], 8, 1e-6);
    }
  }
}

}  // namespace tilted_measurements_test
}  // namespace bernal
