// Parts in another unit than the scene's: their corners are the exact products, which are doubles as a rule
// nowhere, and the certificate is of these.
#include "cad/exact_corners.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/meshes.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace exact_corners_test {

using Rational = boost::multiprecision::cpp_rational;
using testing::Folder;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A box in a unit, as a scene in another one has it.
struct Converted {
  Ratio ratio;
  Mesh mesh;
  std::vector<Vector<3>> as_written;
  Vector<3> lower, upper;  ///< in the file's unit

  Converted(const Vector<3>& corner, const Vector<3>& size, Unit file, Unit scene)
      : ratio(conversion_ratio(file, scene)),
        mesh(test::box_mesh(corner, size)),
        as_written(mesh.vertices),
        lower(bounds_of(mesh).lower),
        upper(bounds_of(mesh).upper) {
    for (Vector<3>& v : mesh.vertices) v *= ratio.nearest();
    cad::state_exactly(mesh, as_written, ratio, {});
  }
  Rational wall(double x) const {
    return Rational(x) * Rational(ratio.numerator) / Rational(ratio.denominator);
  }
  bool holds(const Vector<3>& c, double r) const {
    for (int k = 0; k < 3; ++k)
      if (Rational(c[k]) - Rational(r) < wall(lower[k]) || Rational(c[k]) + Rational(r) > wall(upper[k]))
        return false;
    return true;
  }
};

bool certified(const Vector<3>& c, double r, const Mesh& mesh, Arithmetic arithmetic) {
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<dynamic>(c), r);
  return certify(spheres, mesh, {.arithmetic = arithmetic}).certified;
}

TEST(ExactCorners, AreWhatIsCertified) {
  Random random(1, stream(Stream::test));
  const std::pair<Unit, Unit> units[] = {{Unit::in, Unit::mm}, {Unit::mm, Unit::in}, {Unit::m, Unit::mm},
                                         {Unit::mm, Unit::m},  {Unit::ft, Unit::um}, {Unit::um, Unit::ft},
                                         {Unit::in, Unit::ft}, {Unit::cm, Unit::nm}};
  std::size_t inside = 0, stated = 0, all = 0;
  for (const auto& [file, scene] : units)
    for (int n = 0; n < 150; ++n) {
      Vector<3> lower, size;
      for (int k = 0; k < 3; ++k) {
        lower[k] = random.uniform(-2, 2);
        size[k] = random.uniform(1, 2);
      }
      const Converted box(lower, size, file, scene);
      stated += box.mesh.exact != nullptr;  // a twelfth may be a double
      const double factor = box.ratio.nearest(), r = factor * random.uniform(0.1, 0.3);
      Vector<3> c = factor * (box.lower + 0.5 * size);
      const int axis = static_cast<int>(random.uniform(0, 3));
      const bool upper = random.uniform(0, 1) < 0.5;
      double& x = c[axis];
      x = upper ? factor * box.upper[axis] - r : factor * box.lower[axis] + r;
      const int steps = static_cast<int>(random.uniform(-2, 3));
      for (int k = 0; k < std::abs(steps); ++k) x = std::nextafter(x, steps > 0 ? infinity : -infinity);
      const bool expected = box.holds(c, r);
      inside += expected;
      ++all;
      for (const Arithmetic arithmetic : {Arithmetic::filtered, Arithmetic::exact})
        EXPECT_EQ(certified(c, r, box.mesh, arithmetic), expected) << n << ' ' << factor;
    }
  EXPECT_GT(stated, all - 20);
  EXPECT_GT(inside, all / 4);
  EXPECT_LT(inside, 3 * all / 4);
}

// A cube of 1.7 inches ends 8.4e-16 mm before what the product is rounded to.
TEST(ExactCorners, OfACubeOfSomeInches) {
  const Folder folder;
  const Mesh cube = test::box_mesh({0, 0, 0}, {1.7, 1.7, 1.7});
  const MeshFile file{.file = folder.write("cube.off", test::as_off(cube)), .unit = Unit::in};
  const Mesh in_mm = read_container_mesh(file, {.unit = Unit::mm}).mesh;
  ASSERT_TRUE(in_mm.exact);
  EXPECT_EQ(in_mm.exact->scale, 5);
  const double end = 1.7 * 25.4, r = 0.5;
  const Vector<3> at_end(end - r, 20, 20), before(std::nextafter(end, 0.0) - r, 20, 20);
  ASSERT_EQ(at_end[0] + r, end);
  EXPECT_FALSE(certified(at_end, r, in_mm, Arithmetic::filtered));
  EXPECT_FALSE(certified(at_end, r, in_mm, Arithmetic::exact));
  EXPECT_TRUE(certified(before, r, in_mm, Arithmetic::filtered));
  Mesh rounded = in_mm;
  rounded.exact = nullptr;
  EXPECT_TRUE(certified(at_end, r, rounded, Arithmetic::exact));
  const Mesh in_inches = read_container_mesh(file, {.unit = Unit::in}).mesh;
  EXPECT_FALSE(in_inches.exact);
}

// Where all products are doubles nothing is to be said; what a repair or a plane made is the double it is.
TEST(ExactCorners, AreStatedWhereTheyAreNoDoubles) {
  EXPECT_FALSE(Converted({0, 0, 0}, {5, 10, 0.625}, Unit::in, Unit::mm).mesh.exact);
  Converted box({0, 0, 0}, {1.7, 1, 1}, Unit::in, Unit::mm);
  Mesh more = box.mesh;
  more.exact = nullptr;
  more.vertices.insert(more.vertices.begin(), Vector<3>(0.1, 0.2, 0.3));  // and in another order
  for (auto& t : more.triangles)
    for (std::uint32_t& v : t) ++v;
  cad::state_exactly(more, box.as_written, box.ratio, {});
  ASSERT_TRUE(more.exact);
  for (std::size_t v = 0; v < more.vertices.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      const Rational is = (Rational(more.exact->high[v][k]) + Rational(more.exact->low[v][k])) / 5;
      EXPECT_EQ(is, v == 0 ? Rational(more.vertices[v][k]) : box.wall(box.as_written[v - 1][k]));
    }
}

// Parts of two units in one container have a common scale.
TEST(ExactCorners, AreThoseOfWhatIsTakenOut) {
  const Converted container({0, 0, 0}, {1.7, 1.7, 1.7}, Unit::in, Unit::m);
  const Converted hole({10, 11, 12}, {10.1, 10.3, 10.7}, Unit::mm, Unit::m);
  Mesh both = container.mesh;
  both.exact = nullptr;
  const auto first = static_cast<std::uint32_t>(both.vertices.size());
  both.vertices.insert(both.vertices.end(), hole.mesh.vertices.begin(), hole.mesh.vertices.end());
  for (auto t : hole.mesh.triangles) both.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  cad::state_exactly(both, container.as_written, container.ratio, std::array{hole.mesh});
  ASSERT_TRUE(both.exact);
  for (std::size_t v = 0; v < both.vertices.size(); ++v)
    for (int k = 0; k < 3; ++k) {
      const Rational is =
          (Rational(both.exact->high[v][k]) + Rational(both.exact->low[v][k])) / Rational(both.exact->scale);
      const Converted& part = v < first ? container : hole;
      EXPECT_EQ(is, part.wall(part.as_written[v % first][k])) << v;
    }
}

TEST(ExactCorners, OfOtherVerticesAreRefused) {
  Converted box({0, 0, 0}, {1.7, 1, 1}, Unit::in, Unit::mm);
  box.mesh.vertices[3][0] += 1e-12;
  EXPECT_THROW(certified({10, 10, 10}, 1, box.mesh, Arithmetic::filtered), Error);
}

}  // namespace exact_corners_test
}  // namespace bernal
