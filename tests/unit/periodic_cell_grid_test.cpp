#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

#include "bernal/core/random.hpp"
#include "near/cell_grid.hpp"

// The grid of a region that repeats itself along all axes, or along some, against a search of all images of
// all spheres.
namespace bernal {
namespace periodic_cell_grid_test {

/// The smallest max_k |c - image|_k over all images: axis by axis.
template <int D>
double cube_distance(const Vector<D>& a, const Vector<D>& b, const Boundary<D>& boundary) {
  double largest = 0;
  for (int k = 0; k < D; ++k) {
    const double d = a[k] - b[k];
    largest = std::max(largest, std::abs(boundary.repeats(k) ? std::remainder(d, boundary.edges[k]) : d));
  }
  return largest;
}

template <int D>
class Region {
 public:
  Region(const Vector<D>& edges, double r_min, double r_max, std::uint32_t count)
      : Region({Vector<D>::Zero(), edges}, Boundary<D>{edges}, r_min, r_max, count) {}
  /// Periods are as long as the bounds.
  Region(const Bounds<D>& bounds, const Boundary<D>& boundary, double r_min, double r_max,
         std::uint32_t count)
      : bounds_(bounds),
        boundary_(boundary),
        r_min_(r_min),
        r_max_(r_max),
        grid_(bounds, boundary, r_min, r_max, count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      centers_.push_back(anywhere());
      radii_.push_back(std::clamp(r_min * std::pow(r_max / r_min, random_.uniform()), r_min, r_max));
      grid_.insert(i, centers_.back(), radii_.back());
    }
  }

  void move_all() {
    for (std::uint32_t i = 0; i < centers_.size(); ++i) grid_.move(i, centers_[i] = anywhere());
  }
  void rescale(double factor) {
    bounds_.upper = boundary_.edges *= factor;
    for (Vector<D>& c : centers_) c *= factor;
    grid_.rescale(boundary_.edges);
  }
  void expect_complete(int queries = 50) {
    for (int q = 0; q < queries; ++q) {
      // A third of the queries stand on a cell's border or outside the box.
      const Vector<D> edges = bounds_.size();
      Vector<D> c = anywhere();
      if (q % 3 == 1) {
        const Vector<D> share = (c - bounds_.lower).cwiseQuotient(edges);
        c = bounds_.lower + (8 * share).array().round().matrix().cwiseProduct(edges) / 8;
      }
      if (q % 3 == 2) c += 3 * boundary_.edges;
      const double reach = q % 5 == 0 ? edges.maxCoeff() : 2 * r_max_ * random_.uniform();
      std::map<std::uint32_t, int> visits;
      grid_.for_each_near(c, reach, [&](std::uint32_t id) { ++visits[id]; });
      for (const auto& [id, count] : visits) EXPECT_EQ(count, 1) << "sphere " << id;
      for (std::uint32_t i = 0; i < centers_.size(); ++i) {
        if (cube_distance<D>(c, centers_[i], boundary_) < reach + radii_[i]) {
          EXPECT_TRUE(visits.contains(i)) << "sphere " << i << " of radius " << radii_[i];
        }
      }
      if (::testing::Test::HasFailure()) return;
    }
  }
  const CellGrid<D>& grid() const { return grid_; }

 private:
  Vector<D> anywhere() { return uniform_point(random_, bounds_); }

  Bounds<D> bounds_;
  Boundary<D> boundary_;
  double r_min_, r_max_;
  Random random_{1, stream(Stream::test)};
  CellGrid<D> grid_;
  std::vector<Vector<D>> centers_;
  std::vector<double> radii_;
};

template <class Dimension>
class PeriodicCellGrid : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(PeriodicCellGrid, Dimensions);

TYPED_TEST(PeriodicCellGrid, FindsAllImagesOnce) {
  constexpr int D = TypeParam::value;
  Region<D> box(Vector<D>::Ones(), 0.03, 0.03, 200);
  box.expect_complete();
  box.move_all();
  box.expect_complete();
}

TYPED_TEST(PeriodicCellGrid, FindsSpheresOfWidelyDifferentSizes) {
  constexpr int D = TypeParam::value;
  Region<D> box(Vector<D>::Ones(), 0.001, 0.2, 200);
  EXPECT_EQ(box.grid().level_count(), 8u);
  box.expect_complete();
  box.move_all();
  box.expect_complete();
}

// One, two and three cells along an edge: going round the box meets the same cell again.
TYPED_TEST(PeriodicCellGrid, FindsAllImagesOnceInBoxesOfFewCells) {
  constexpr int D = TypeParam::value;
  for (const double r : {0.6, 0.5, 0.4, 0.25, 0.2, 1.0 / 6, 0.13}) {
    Region<D> box(Vector<D>::Ones(), r / 3, r, 20);
    box.expect_complete();
    box.move_all();
    box.expect_complete();
  }
}

TYPED_TEST(PeriodicCellGrid, FindsAllImagesInALongBox) {
  constexpr int D = TypeParam::value;
  Vector<D> edges = Vector<D>::Ones();
  edges[D - 1] = 10;
  Region<D> box(edges, 0.05, 0.3, 200);
  box.expect_complete();
}

TYPED_TEST(PeriodicCellGrid, FollowsABoxThatGrowsAndShrinks) {
  constexpr int D = TypeParam::value;
  Region<D> box(Vector<D>::Ones(), 0.02, 0.1, 200);
  for (const double factor : {1.1, 2.0, 1 / 3.0}) {
    box.rescale(factor);
    box.expect_complete();
    box.move_all();
    box.expect_complete();
  }
}

// Every rescaling rounds every centre; none of them moves.
TYPED_TEST(PeriodicCellGrid, FollowsManySmallRescalings) {
  constexpr int D = TypeParam::value;
  Region<D> box(Vector<D>::Ones(), 0.02, 0.02, 300);
  for (int step = 0; step < 20'000; ++step) box.rescale(1 + 1e-5);
  box.expect_complete();
}

TYPED_TEST(PeriodicCellGrid, HasNoMoreCellsThanTheSpheresAreWorth) {
  constexpr int D = TypeParam::value;
  const CellGrid<D> grid(Boundary<D>{Vector<D>::Ones()}, 1e-5, 1e-3, 1000);
  EXPECT_LE(grid.cell_count(), grid.level_count() * 4000);
}

/// Every choice of axes that repeat themselves, and a corner anywhere.
TYPED_TEST(PeriodicCellGrid, FindsAllImagesAlongTheAxesThatHaveSome) {
  constexpr int D = TypeParam::value;
  for (int axes = 0; axes < 1 << D; ++axes) {
    Bounds<D> bounds;
    Boundary<D> boundary;
    for (int k = 0; k < D; ++k) {
      bounds.lower[k] = 3.7 * k - 5;
      bounds.upper[k] = bounds.lower[k] + 1 + 0.3 * k;
      if (axes >> k & 1) boundary.edges[k] = bounds.size()[k];
      boundary.origin[k] = bounds.lower[k];
    }
    for (const double r : {0.6, 0.3, 0.2, 0.13, 0.03}) {
      SCOPED_TRACE(::testing::Message() << "axes " << axes << ", radius " << r);
      Region<D> region(bounds, boundary, r / 3, r, 100);
      region.expect_complete();
      region.move_all();
      region.expect_complete();
    }
  }
}

TEST(PeriodicCells, LooksAtTwentySevenCells) {
  const double r = 0.01;
  CellGrid<3> grid(Boundary<3>{Vector<3>::Ones()}, r, r, 100'000);
  Random random(2, stream(Stream::test));
  constexpr std::uint32_t n = 10'000;
  const Bounds<3> bounds{Vector<3>::Zero(), Vector<3>::Ones()};
  for (std::uint32_t i = 0; i < n; ++i) grid.insert(i, uniform_point(random, bounds), r);
  std::size_t visited = 0;
  grid.for_each_near(Vector<3>::Constant(0.999), r, [&](std::uint32_t) { ++visited; });
  const double expected = 27 * 8e-6 * n;  // cells of edge 2 r
  EXPECT_LE(static_cast<double>(visited), expected + 6 * std::sqrt(expected));
}

// Who is deep inside of a large sphere asks for less than nothing; small ones are never so near.
TEST(PeriodicCells, KnowOfReachesBelowZero) {
  const Boundary<3> box{Vector<3>::Constant(10)};
  CellGrid<3> grid(box, 0.01, 1, 100);
  const Vector<3> at(9.99, 0.01, 5);
  grid.insert(0, at, 1);
  for (std::uint32_t i = 1; i < 100; ++i) grid.insert(i, Vector<3>::Constant(0.1 * i), 0.01);
  for (const double reach : {-0.005, -0.5, -0.99}) {
    std::vector<int> visits(100, 0);
    grid.for_each_near(at, reach, [&](std::uint32_t i) { ++visits[i]; });
    EXPECT_EQ(visits[0], 1) << reach;
    EXPECT_LE(std::ranges::max(visits), 1) << reach;
  }
}

}  // namespace periodic_cell_grid_test
}  // namespace bernal
