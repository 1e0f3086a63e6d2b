#include <gtest/gtest.h>

#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {
namespace analytic_container_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(AnalyticContainer, AbsurdShapesAreRefused) {
  const Domain absurd[] = {
      Mesh{},
      Box{{0, 0, 0}, {1, 0, 1}},
      Box{{0, infinity, 0}, {1, 1, 1}},
      Cylinder{{0, 0, 0}, {0, 0, 0}, 1, 1},
      Cylinder{{0, 0, 0}, {0, 0, 1}, -1, 1},
      Cylinder{{0, 0, 0}, {0, 0, 1}, 1, std::nan("")},
      Cylinder{{0, 0, 0}, {0, 1, 1}, 1, 1, true},
      Box{{0}, {1}},
      Box{{0, 0, 0, 0}, {1, 1, 1, 1}},
      Box{{0, 0, 0}, {1, 1, 1}, {true}},
      Sphere{{0, 0, 0}, 0},
  };
  for (const Domain& shape : absurd)
    EXPECT_THROW(make_analytic_container(shape, WallArithmetic::plain, 1e-16), Error) << kind_of(shape);
}

// Only the direction of the axis counts, of whatever length.
TEST(AnalyticContainer, AnAxisOfAnyLengthGivesTheSameCylinder) {
  const auto unit =
      make_analytic_container(Cylinder{{0, 0, 0}, {0.6, 0, 0.8}, 1, 2}, WallArithmetic::filtered, 1e-15);
  for (const double length : {1e-200, 1e-9, 7.0, 1e200}) {
    const Cylinder shape{{0, 0, 0}, length * Vector<3>(0.6, 0, 0.8), 1, 2};
    const auto same = make_analytic_container(shape, WallArithmetic::filtered, 1e-15);
    Random random(5, stream(Stream::test));
    for (int i = 0; i < 100; ++i) {
      const Vector<3> p = uniform_point<3>(random, unit->bounds());
      EXPECT_NEAR(same->clearance(p), unit->clearance(p), 1e-14);
      EXPECT_EQ(same->contains(p, 0.1), unit->contains(p, 0.1));
    }
  }
}

}  // namespace analytic_container_test
}  // namespace bernal
