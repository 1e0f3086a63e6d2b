#include "near/cell_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <type_traits>

#include "bernal/core/random.hpp"

// The oracle is a map of all spheres that is searched from end to end.
namespace bernal {
namespace cell_grid_test {

template <int D>
struct Sphere {
  Vector<D> center;
  double r;
};

template <int D>
Bounds<D> unit_bounds() {
  return {Vector<D>::Zero(), Vector<D>::Ones()};
}

/// A grid and what must be in it.
template <int D>
class Watched {
 public:
  using Id = typename CellGrid<D>::Id;

  Watched(const Bounds<D>& bounds, double r_min, double r_max, std::size_t expected)
      : grid_(bounds, r_min, r_max, expected) {}

  void insert(Id id, const Vector<D>& c, double r) {
    grid_.insert(id, c, r);
    spheres_[id] = {c, r};
  }
  void move(Id id, const Vector<D>& c) {
    grid_.move(id, c);
    spheres_.at(id).center = c;
  }
  void clear() {
    grid_.clear();
    spheres_.clear();
  }
  bool holds(Id id) const { return spheres_.contains(id); }
  const CellGrid<D>& grid() const { return grid_; }

  /// All that is near is visited, nothing twice, and nothing that is not there.
  void expect_complete(const Vector<D>& c, double reach) const {
    std::map<Id, int> visits;
    grid_.for_each_near(c, reach, [&](Id id) { ++visits[id]; });
    for (const auto& [id, count] : visits) {
      EXPECT_EQ(count, 1) << "sphere " << id;
      EXPECT_TRUE(holds(id)) << "sphere " << id;
    }
    for (const auto& [id, sphere] : spheres_) {
      if ((sphere.center - c).norm() < reach + sphere.r) {
        EXPECT_TRUE(visits.contains(id)) << "sphere " << id << " of radius " << sphere.r << " at distance "
                                         << (sphere.center - c).norm() << ", reach " << reach;
      }
    }
  }

 private:
  CellGrid<D> grid_;
  std::map<Id, Sphere<D>> spheres_;
};

struct Case {
  double r_min, r_max;
  std::size_t expected;
};

/// Inserts and moves at random; `place` makes the centres.
template <int D, class Place>
void expect_complete_throughout(const Bounds<D>& bounds, const Case& tested, Place place) {
  Watched<D> watched(bounds, tested.r_min, tested.r_max, tested.expected);
  Random random(1, stream(Stream::test));
  const auto radius = [&] {  // as many in every octave of sizes
    const double r = tested.r_min * std::pow(tested.r_max / tested.r_min, random.uniform());
    return std::clamp(r, tested.r_min, tested.r_max);
  };
  constexpr std::uint32_t ids = 200;
  for (int step = 0; step < 3000; ++step) {
    const auto id = static_cast<std::uint32_t>(random.uniform() * ids);
    if (!watched.holds(id)) {
      watched.insert(id, place(random), radius());
    } else {
      watched.move(id, place(random));
    }
    if (step % 10 == 0) {
      const double reach = tested.r_max * 2 * random.uniform();
      watched.expect_complete(place(random), reach);
      if (::testing::Test::HasFailure()) return;
    }
  }
}

template <class Dimension>
class CellGridLaws : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                                    std::integral_constant<int, 5>>;
TYPED_TEST_SUITE(CellGridLaws, Dimensions);

TYPED_TEST(CellGridLaws, FindsAllNeighboursOfEqualSpheres) {
  constexpr int D = TypeParam::value;
  const auto anywhere = [](Random& random) { return uniform_point(random, unit_bounds<D>()); };
  expect_complete_throughout<D>(unit_bounds<D>(), {0.05, 0.05, 200}, anywhere);
}

TYPED_TEST(CellGridLaws, FindsAllNeighboursOfWidelyDifferentSpheres) {
  constexpr int D = TypeParam::value;
  const auto anywhere = [](Random& random) { return uniform_point(random, unit_bounds<D>()); };
  expect_complete_throughout<D>(unit_bounds<D>(), {0.002, 0.2, 200}, anywhere);
}

TYPED_TEST(CellGridLaws, FindsAllNeighboursInAClusterAndOnCellBorders) {
  constexpr int D = TypeParam::value;
  const auto cluster = [](Random& random) -> Vector<D> {
    const Vector<D> p = uniform_point(random, unit_bounds<D>());
    if (random.uniform() < 0.5) return Vector<D>::Constant(0.37) + 0.01 * p;
    return (10 * p).array().round() / 10;  // cells of r = 0.05 have an edge of 0.1
  };
  expect_complete_throughout<D>(unit_bounds<D>(), {0.05, 0.05, 200}, cluster);
}

TYPED_TEST(CellGridLaws, FindsAllNeighboursBeyondTheBounds) {
  constexpr int D = TypeParam::value;
  const auto beyond = [](Random& random) -> Vector<D> {
    return 3 * uniform_point(random, unit_bounds<D>()) - Vector<D>::Ones();
  };
  expect_complete_throughout<D>(unit_bounds<D>(), {0.01, 0.2, 200}, beyond);
}

TYPED_TEST(CellGridLaws, FindsAllNeighboursInFlatBounds) {
  constexpr int D = TypeParam::value;
  Bounds<D> flat = unit_bounds<D>();
  flat.lower[D - 1] = flat.upper[D - 1] = 0.5;
  const auto in_plane = [&](Random& random) { return uniform_point(random, flat); };
  expect_complete_throughout<D>(flat, {0.01, 0.1, 200}, in_plane);
}

TYPED_TEST(CellGridLaws, FindsAllNeighboursWhenMoreComeThanExpected) {
  constexpr int D = TypeParam::value;
  const auto anywhere = [](Random& random) { return uniform_point(random, unit_bounds<D>()); };
  expect_complete_throughout<D>(unit_bounds<D>(), {0.001, 0.01, 1}, anywhere);
}

// 1e-4 of the edge would be 1e12 cells in three dimensions and 1e20 in five.
TYPED_TEST(CellGridLaws, HasNoMoreCellsThanTheSpheresAreWorth) {
  constexpr int D = TypeParam::value;
  for (const std::size_t expected : {std::size_t{0}, std::size_t{1}, std::size_t{1000}}) {
    const CellGrid<D> grid(unit_bounds<D>(), 1e-5, 1e-3, expected);
    const std::size_t cells_a_level = std::max<std::size_t>(64, 4 * expected);
    EXPECT_LE(grid.cell_count(), grid.level_count() * cells_a_level) << expected;
  }
}

TEST(CellGrid, HasALevelForEveryHalving) {
  const Bounds<3> bounds = unit_bounds<3>();
  EXPECT_EQ(CellGrid<3>(bounds, 0.1, 0.1, 100).level_count(), 1u);
  EXPECT_EQ(CellGrid<3>(bounds, 0.06, 0.1, 100).level_count(), 1u);
  EXPECT_EQ(CellGrid<3>(bounds, 0.04, 0.1, 100).level_count(), 2u);
  EXPECT_EQ(CellGrid<3>(bounds, 0.001, 0.1, 100).level_count(), 7u);  // 2^6 < 100 < 2^7
}

TEST(CellGrid, VisitsOnlyWhatIsInReachOfACell) {
  CellGrid<3> grid(unit_bounds<3>(), 0.01, 0.01, 100'000);
  Random random(2, stream(Stream::test));
  constexpr std::uint32_t n = 10'000;
  for (std::uint32_t i = 0; i < n; ++i) grid.insert(i, uniform_point(random, unit_bounds<3>()), 0.01);
  std::size_t visited = 0;
  grid.for_each_near(Vector<3>::Constant(0.5), 0.01, [&](std::uint32_t) { ++visited; });
  // The cube of half-width reach + r meets 2 or 3 cells of edge 0.02 along each axis: 27 cells of volume
  // 8e-6.
  const double expected = 27 * 8e-6 * n;
  EXPECT_LE(static_cast<double>(visited), expected + 6 * std::sqrt(expected));
}

TEST(CellGrid, StopsAtTheFirstThatIsEnough) {
  CellGrid<2> grid(unit_bounds<2>(), 0.1, 0.1, 10);
  for (std::uint32_t i = 0; i < 10; ++i) grid.insert(i, Vector<2>::Constant(0.5), 0.1);
  int visits = 0;
  const auto third = [&](std::uint32_t) { return ++visits == 3; };
  EXPECT_TRUE(grid.any_near(Vector<2>::Constant(0.5), 0.1, third));
  EXPECT_EQ(visits, 3);
  const auto never = [](std::uint32_t) { return false; };
  EXPECT_FALSE(grid.any_near(Vector<2>::Constant(0.5), 0.1, never));
}

TEST(CellGrid, IsEmptyAfterClearAndCanBeFilledAgain) {
  Watched<3> watched(unit_bounds<3>(), 0.01, 0.2, 100);
  Random random(3, stream(Stream::test));
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t i = 0; i < 100; ++i)
      watched.insert(i, uniform_point(random, unit_bounds<3>()), random.uniform(0.01, 0.2));
    watched.expect_complete(Vector<3>::Constant(0.5), 2);
    watched.clear();
    watched.expect_complete(Vector<3>::Constant(0.5), 2);
  }
}

}  // namespace cell_grid_test
}  // namespace bernal
