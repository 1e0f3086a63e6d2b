#include "soft/fixed_point_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bernal/core/boundary.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"

namespace bernal {
namespace fixed_point_grid_test {

/// Looks at all points from each of them and returns how many it looked at on average.
template <int D>
double expect_complete(std::size_t n, const Vector<D>& edges, double reach) {
  Random random(D, stream(Stream::test));
  std::vector<Vector<D>> points(n);
  std::vector<FixedPlace<D>> places(n, FixedPlace<D>{});
  for (std::size_t i = 0; i < n; ++i) {
    points[i] = uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges});
    for (int k = 0; k < D; ++k) places[i].x[k] = to_fixed(points[i][k], edges[k]);
  }
  FixedPointGrid<D> grid;
  const std::vector<std::uint32_t> order = grid.sort(edges, reach, places, n);
  std::vector<std::uint32_t> sorted = order;
  std::ranges::sort(sorted);
  for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(sorted[i], i) << "not a permutation";

  const Boundary<D> boundary{edges};
  std::vector<typename FixedPointGrid<D>::Row> rows;
  double looked_at = 0;
  for (std::size_t i = 0; i < n; ++i) {
    grid.rows_near(places[i], rows);
    std::vector<int> met(n, 0);
    for (const auto& row : rows)
      for (std::uint32_t k = row.first; k < row.last; ++k) ++met[k];
    for (std::size_t j = 0; j < n; ++j) {
      const int times = met[order[j]];
      looked_at += times;
      EXPECT_LE(times, 1) << i << " meets " << j << " twice";
      // Fixed point is good to 2^-32 of an edge.
      if (boundary.minimum_image(points[i] - points[j]).norm() < reach * (1 - 1e-6)) {
        EXPECT_EQ(times, 1) << i << " does not meet " << j;
      }
    }
  }
  return looked_at / static_cast<double>(n);
}

template <class T>
class FixedPointGridTest : public ::testing::Test {};
template <int D>
using Int = std::integral_constant<int, D>;
using Dimensions = ::testing::Types<Int<1>, Int<2>, Int<3>, Int<4>, Int<5>, Int<6>, Int<7>, Int<8>>;
TYPED_TEST_SUITE(FixedPointGridTest, Dimensions);

TYPED_TEST(FixedPointGridTest, MeetsEveryNeighborOnce) {
  constexpr int D = TypeParam::value;
  constexpr std::size_t n = 400;
  Vector<D> edges = Vector<D>::Ones();
  edges[D - 1] = 1.7;
  EXPECT_LT(expect_complete<D>(n, edges, 0.11), n / 2.0);  // one axis is cut, or two
  EXPECT_EQ(expect_complete<D>(n, edges, 0.45), n);        // two or three cells across are of no use
  EXPECT_EQ(expect_complete<D>(3, edges, 0.11), 3);        // looking at cells costs more than at three points
}

}  // namespace fixed_point_grid_test
}  // namespace bernal
