// Containers of sizes from a nanometre to a million kilometres, up to 1e8 diagonals away from the origin:
// motion in the local frame, the answer carried back into the scene and decided there in exact arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "bernal/core/random.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/container.hpp"
#include "domain/exact_analytic.hpp"

namespace bernal {
namespace far_and_scaled_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool contains_exactly(const Domain& shape, const Vector<3>& c, double r) {
  if (const auto* box = std::get_if<Box>(&shape)) return bernal::contains_exactly(*box, c, r);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) return bernal::contains_exactly(*cylinder, c, r);
  return bernal::contains_exactly(std::get<Sphere>(shape), c, r);
}

class FarAndScaled : public ::testing::TestWithParam<std::tuple<double, double>> {
 protected:
  double size = std::get<0>(GetParam());
  Vector<3> offset = size * std::get<1>(GetParam()) * Vector<3>(0.48, -0.6, 0.64);
  std::vector<Domain> shapes = {
      Box{offset, size* Vector<3>(1, 0.7, 1.9)},
      Cylinder{offset, {1, 2, -2}, 0.7 * size, 1.3 * size},
      Cylinder{offset, {0, 0, 1e-5}, 0.3 * size, 1.3 * size},
      Sphere{offset, 0.77 * size},
  };
};

// A sphere wanders from wall to wall; wherever it stops, it lies inside the container of the scene, at its
// own radius, in exact arithmetic. This is what the skin is for: it outlasts the rounding of the way back.
TEST_P(FarAndScaled, WhereverASphereStopsItLiesInsideExactly) {
  for (const Domain& shape : shapes) {
    SCOPED_TRACE(kind_of(shape));
    const Frame frame = frame_of(shape);
    const auto container =
        make_analytic_container(to_local(shape, frame), WallArithmetic::filtered, frame.resolution);
    Random random(1, stream(Stream::test));
    int stops = 0;
    for (int trial = 0; trial < 20; ++trial) {
      // Far away the skin is wide, and a sphere must be larger than it to be packed at all.
      const double scene_radius = std::pow(10, random.uniform(-2.5, -1)) * frame.scale;
      const double r = scene_radius / frame.scale;
      const double skin = tolerance::skin(r, frame.resolution);
      ASSERT_LT(skin, r);
      Vector<3> c = frame.to_local(bounds_of(shape).center());
      for (int move = 0; move < 50; ++move) {
        const Vector<3> direction = uniform_direction<3>(random);
        const double answer = container->first_contact(c, r, direction, 1);
        stops += answer < 1;
        c += answer * direction;
        ASSERT_GE(container->clearance(c) - r, skin / 2 - 16 * frame.resolution);
        ASSERT_TRUE(contains_exactly(shape, frame.to_scene(c), scene_radius))
            << "trial " << trial << " move " << move;
      }
    }
    EXPECT_GT(stops, 300);
  }
}

TEST_P(FarAndScaled, FilteredIsExactNearTheWall) {
  for (const Domain& shape : shapes) {
    SCOPED_TRACE(kind_of(shape));
    const Frame frame = frame_of(shape);
    // In the scene's own coordinates, without a frame: the filter's bound has to know where it stands.
    const auto filtered =
        make_analytic_container(shape, WallArithmetic::filtered, frame.resolution * frame.scale);
    const auto exact = make_analytic_container(shape, WallArithmetic::exact, frame.resolution * frame.scale);
    Random random(2, stream(Stream::test));
    const Bounds<3> bounds = bounds_of(shape);
    int inside = 0, outside = 0;
    for (int i = 0; i < 100; ++i) {
      const Vector<3> c = uniform_point<3>(random, bounds);
      double r = filtered->clearance(c);
      if (r <= 0) continue;
      for (int k = 0; k < 4; ++k) r = std::nextafter(r, 0);
      for (int k = 0; k < 8; ++k, r = std::nextafter(r, infinity)) {
        const bool answer = exact->contains(c, r);
        EXPECT_EQ(filtered->contains(c, r), answer);
        (answer ? inside : outside) += 1;
      }
    }
    EXPECT_GT(inside, 50);
    EXPECT_GT(outside, 50);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FarAndScaled,
                         ::testing::Combine(::testing::Values(1e-9, 1e-6, 1.0, 1e6, 1e9),
                                            ::testing::Values(0.0, 1.0, 1e4, 1e8)));

}  // namespace far_and_scaled_test
}  // namespace bernal
