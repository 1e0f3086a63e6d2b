// The upper corner of a box is a sum of two doubles and most often none itself: what is certified, what is
// asked of walls and what is packed mean the sum.
#include <gtest/gtest.h>

#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/rounding.hpp"
#include "support/packing_oracle.hpp"

namespace bernal {
namespace exact_box_test {

using oracle::Rational;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ball at the upper wall of an axis, nearer or farther by some doubles.
struct Touching {
  Box box;
  Vector<dynamic> center;
  double r;
};
Touching touching(Random& random, int dimension) {
  const double scale = std::exp2(random.uniform(-4, 4));
  Touching t{{Vector<dynamic>(dimension), Vector<dynamic>(dimension)},
             Vector<dynamic>(dimension),
             scale * random.uniform(0.01, 0.1)};
  for (int k = 0; k < dimension; ++k) {
    t.box.corner[k] = scale * random.uniform(-2, 2);
    t.box.size[k] = scale * random.uniform(0.5, 2);
    t.center[k] = t.box.corner[k] + 0.5 * t.box.size[k];
  }
  const int axis = static_cast<int>(random.uniform(0, dimension));
  double& x = t.center[axis];
  x = t.box.corner[axis] + t.box.size[axis] - t.r;
  for (int k = static_cast<int>(random.uniform(0, 5)); k > 2; --k) x = std::nextafter(x, infinity);
  for (int k = static_cast<int>(random.uniform(0, 5)); k > 2; --k) x = std::nextafter(x, -infinity);
  return t;
}

Spheres<dynamic> one_sphere(const Vector<dynamic>& c, double r) {
  Spheres<dynamic> spheres(static_cast<int>(c.size()));
  spheres.push_back(c, r);
  return spheres;
}

TEST(ExactBox, IsWhatIsCertified) {
  Random random(1, stream(Stream::test));
  std::size_t inside = 0, inexact = 0;
  for (int k = 0; k < 1000; ++k) {
    const Touching t = touching(random, 2 + k % 2);
    const bool expected = oracle::inside(t.center, t.r, t.box);
    inside += expected;
    for (int axis = 0; axis < t.box.dimension(); ++axis)
      inexact += !is_exact_sum(t.box.corner[axis], t.box.size[axis]);
    for (const Arithmetic arithmetic : {Arithmetic::filtered, Arithmetic::exact})
      EXPECT_EQ(certify(one_sphere(t.center, t.r), t.box, {.arithmetic = arithmetic}).certified, expected)
          << k;
  }
  EXPECT_GT(inside, 250u);
  EXPECT_LT(inside, 870u);
  EXPECT_GT(inexact, 600u);
}

// Box and sphere of a report: 0.1 + 0.2 is rounded up, and the sphere ends at what it is rounded to.
TEST(ExactBox, IsNotWhatItsCornerIsRoundedTo) {
  const Box box{Vector<3>(0.1, 0, 0), Vector<3>(0.2, 1, 1)};
  const Vector<3> rounded(0.23750000000000004, 0.5, 0.5), before(0.23750000000000002, 0.5, 0.5);
  const Certificate outside = certify(one_sphere(rounded, 0.0625), box);
  EXPECT_FALSE(outside.certified);
  EXPECT_EQ(outside.protruding_spheres, 1u);
  EXPECT_LT(outside.min_wall_gap, 0);
  EXPECT_TRUE(certify(one_sphere(before, 0.0625), box).certified);
  EXPECT_FALSE(certify(one_sphere(before, 0.0625), box, {.wall_gap = 1e-16}).certified);
}

TEST(ExactBox, IsWhatItsContainerAnswersFor) {
  Random random(2, stream(Stream::test));
  for (int k = 0; k < 1000; ++k) {
    const Touching t = touching(random, 2 + k % 2);
    const bool expected = oracle::inside(t.center, t.r, t.box);
    Vector<3> c = Vector<3>::Zero();
    c.head(t.center.size()) = t.center;
    for (const WallArithmetic arithmetic : {WallArithmetic::filtered, WallArithmetic::exact})
      EXPECT_EQ(make_analytic_container(t.box, arithmetic, 1e-15)->contains(c, t.r), expected) << k;
  }
}

// Moved inwards, nothing is left that the exact walls would not have so much away.
TEST(ExactBox, IsWhatWallsAreMovedFrom) {
  Random random(3, stream(Stream::test));
  for (int k = 0; k < 500; ++k) {
    const Box box = touching(random, 3).box;
    const double by = random.uniform(-0.1, 0.1);
    const Box moved = std::get<Box>(with_walls_moved(box, by));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(Rational(moved.corner[axis]), Rational(box.corner[axis]) + Rational(by));
      EXPECT_LE(Rational(moved.corner[axis]) + Rational(moved.size[axis]),
                Rational(box.corner[axis]) + Rational(box.size[axis]) - Rational(by));
    }
  }
}

Packing packed(const std::string& toml) { return run(build(parse_scene(toml, "scene.toml"))); }

// A sphere as wide as the box has one place; a box of tenths is filled with ones that touch its walls.
TEST(ExactBox, IsPackedAndTheResultIsCertified) {
  const Packing snug = packed(
      "[container]\nkind = \"box\"\ncorner = [0.1, 0.1, 0.1]\nsize = [0.2, 0.2, 0.2]\n[spheres]\ndiameter = "
      "0.2\ncount = 1\n");
  EXPECT_EQ(snug.spheres.size(), 1u) << "0.1 + 0.1 and 0.2 + 0.1 are met exactly";
  EXPECT_TRUE(certify(snug.spheres, snug.domain).certified);
  const std::string tenths =
      "[container]\nkind = \"box\"\ncorner = [0.1, 0.7, -0.3]\nsize = [0.2, 0.2, 0.2]\n";
  for (const char* spheres : {"diameter = 0.05\nfill = true\n", "diameter = 0.099999999999999\ncount = 8\n",
                              "diameter = 0.05\ncount = 20\nwall_gap = 0.01\n"}) {
    const Packing packing = packed(tenths + "[spheres]\n" + spheres);
    EXPECT_GT(packing.spheres.size(), 0u);
    EXPECT_TRUE(certify(packing.spheres, packing.domain, {.wall_gap = packing.scene.wall_gap}).certified)
        << spheres;
    const Scene again = parse_scene(scene_as_toml(packing.scene), "scene.toml");
    const Box was = std::get<Box>(packing.domain), is = std::get<Box>(domain_of(again));
    EXPECT_TRUE(was.corner == is.corner && was.size == is.size);
  }
}

}  // namespace exact_box_test
}  // namespace bernal
