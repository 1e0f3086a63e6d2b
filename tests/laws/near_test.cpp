#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bernal/core/random.hpp"
#include "support/near_indices.hpp"

// What is near is found by every index as by looking at all spheres, and nothing that is not there.
namespace bernal {
namespace near_test {

struct Case {
  std::size_t count;
  double smallest, largest;  ///< radii, as many of each octave
  double reach;
  double stretch = 1;  ///< of the first edge, which is 1
};

const Case cases[] = {
    {1, 0.1, 0.1, 0.2},        {2, 0.4, 0.4, 0.05},       {300, 0.02, 0.02, 0.03},
    {300, 0.001, 0.2, 0.05},   {300, 0.05, 0.06, 0, 0.4}, {500, 0.02, 0.03, 0.02, 12},
    {64, 0.1, 0.2, 0.1, 0.45},
};

template <int D>
Spheres<D> spheres_of(const Case& of, const Vector<D>& edges, Random& random) {
  Spheres<D> spheres;
  for (std::size_t i = 0; i < of.count; ++i) {
    Vector<D> c = uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges});
    if (i % 5 == 0) c = (8 * c.cwiseQuotient(edges)).array().floor().matrix().cwiseProduct(edges) / 8;
    const double r = of.smallest * std::pow(of.largest / of.smallest, random.uniform());
    spheres.push_back(c, std::clamp(r, of.smallest, of.largest));
  }
  return spheres;
}

template <class Index, int D>
void expect_what_all_pairs_find() {
  for (const Case& of : cases) {
    SCOPED_TRACE(::testing::Message() << of.count << " spheres, stretched by " << of.stretch);
    Random random(D, stream(Stream::test));
    Vector<D> edges = Vector<D>::Ones();
    edges[0] = of.stretch;
    const Spheres<D> spheres = spheres_of<D>(of, edges, random);
    const test::AllPairs<D> oracle(spheres, edges, of.reach);
    const Index index(spheres, edges, of.reach);
    for (int query = 0; query < 200; ++query) {
      Vector<D> c = uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges});
      if (query % 4 == 0) c = spheres.center(static_cast<std::size_t>(query) % spheres.size());
      if (query % 4 == 1) c[query % D] = 0;
      std::map<std::uint32_t, int> visits;
      index.near(c, [&](std::uint32_t i) { ++visits[i]; });
      for (const auto& [i, count] : visits) ASSERT_LT(i, spheres.size());
      oracle.near(c, [&](std::uint32_t i) {
        ASSERT_TRUE(visits.contains(i))
            << "sphere " << i << " of radius " << spheres.r[i] << " at " << (spheres.center(i) - c).norm();
      });
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

template <class Index>
class NearLaws : public ::testing::Test {};

template <template <int> class Index>
struct Of {
  template <int D>
  using In = Index<D>;
};
using Indices = ::testing::Types<Of<test::InCellGrid>, Of<test::InPointGrid>, Of<test::InPartialGrid>,
                                 Of<test::InSphereTree>, Of<test::InBoxTree>, Of<test::InLinkedCells>,
                                 Of<test::InSortedCells>, Of<test::InHomeGrid>, Of<test::InFixedPointGrid>>;
TYPED_TEST_SUITE(NearLaws, Indices);

TYPED_TEST(NearLaws, FindAllThatIsNearInTwoAndThreeDimensions) {
  expect_what_all_pairs_find<typename TypeParam::template In<2>, 2>();
  expect_what_all_pairs_find<typename TypeParam::template In<3>, 3>();
}

}  // namespace near_test
}  // namespace bernal
