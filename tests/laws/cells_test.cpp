// Every domain is filled by the cells of the spheres in it.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/local_packing.hpp"
#include "domain/places.hpp"
#include "support/containers.hpp"

namespace bernal {
namespace cells_test {

using test::ContainerUnderTest;

class Cells : public ::testing::TestWithParam<ContainerUnderTest> {};

/// Spheres of many sizes that neither overlap nor stick out.
Spheres<dynamic> disjoint_spheres(const Container& container, std::size_t n) {
  const Places places(container);
  Random random(11, stream(Stream::test));
  Spheres<dynamic> spheres(3);
  for (int tries = 0; tries < 20'000 && spheres.size() < n; ++tries) {
    const Vector<3> c = places.draw(random);
    double room = std::min(0.1, container.clearance(c));
    for (std::size_t i = 0; i < spheres.size(); ++i)
      room = std::min(room, container.boundary().minimum_image(c - spheres.center(i)).norm() - spheres.r[i]);
    if (room > 1e-3) spheres.push_back(c, room * (1 - 1e-9));
  }
  return spheres;
}

TEST_P(Cells, FillTheDomainAndHoldTheirSpheres) {
  const auto container = GetParam().container(WallArithmetic::plain);
  if (is_repeated_mesh(GetParam().shape)) {  // of which no cells are known
    EXPECT_THROW((void)local_packing(disjoint_spheres(*container, 3), GetParam().shape), Error);
    return;
  }
  for (const std::size_t n : {1, 3, 200}) {
    const Spheres<dynamic> spheres = disjoint_spheres(*container, n);
    ASSERT_GE(spheres.size(), std::min<std::size_t>(n, 3));
    const auto local = local_packing(spheres, GetParam().shape);
    ASSERT_TRUE(local);
    EXPECT_LT(local->volume_error, 1e-9) << n;
    EXPECT_EQ(local->empty, 0u);
    RecordProperty("volume_error_of_" + std::to_string(n), fmt::format("{:.2g}", local->volume_error));
    for (std::size_t i = 0; i < spheres.size(); ++i)
      EXPECT_GE(local->cell_volume[i], (1 - 1e-9) * ball_volume(3, spheres.r[i])) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Cells, ::testing::ValuesIn(test::containers_under_test()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace cells_test
}  // namespace bernal
