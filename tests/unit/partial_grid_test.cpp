#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bernal/core/random.hpp"
#include "near/partial_grid.hpp"

// The grid over the first few axes against a look at every sphere, on every number of axes, with and without
// images.
namespace bernal {
namespace partial_grid_test {

template <int D>
class Scatter {
 public:
  Scatter(std::size_t count, double edge, std::array<bool, D> repeats)
      : repeats_(repeats), edges_(Vector<D>::Constant(edge)) {
    for (std::size_t i = 0; i < count; ++i) {
      spheres_.push_back(anywhere(), 0.1 * (1 + random_.uniform()));
    }
  }
  Vector<D> anywhere() { return uniform_point(random_, Bounds<D>{Vector<D>::Zero(), edges_}); }
  double squared_distance(const Vector<D>& a, const Vector<D>& b) const {
    double sum = 0;
    for (int k = 0; k < D; ++k) {
      const double d = repeats_[k] ? std::remainder(a[k] - b[k], edges_[k]) : a[k] - b[k];
      sum += d * d;
    }
    return sum;
  }
  PartialGrid grid(int axes, double slack = 0) const {
    PartialGrid grid(edges_, each_axis(), 0.5, slack, spheres_.size(), axes);
    grid.set_largest(0.2);
    grid.sort(columns_of(spheres_.x), spheres_.r, spheres_.size());
    return grid;
  }
  /// Every sphere that is near comes once, with its distance, and no other.
  void expect_complete(const PartialGrid& grid) {
    for (int query = 0; query < 30; ++query) {
      const Vector<D> c = anywhere();
      const double reach = 0.3 * random_.uniform();
      std::map<std::uint32_t, double> found;
      grid.for_each_near(c.data(), reach, [&](std::uint32_t id, double squared) {
        EXPECT_TRUE(found.emplace(id, squared).second) << "sphere " << id << " comes twice";
      });
      for (std::uint32_t i = 0; i < spheres_.size(); ++i) {
        const double squared = squared_distance(c, spheres_.center(i)), limit = reach + spheres_.r[i];
        ASSERT_EQ(found.contains(i), squared < limit * limit) << "sphere " << i;
        if (found.contains(i)) {
          ASSERT_NEAR(found[i], squared, 1e-13);
        }
      }
    }
  }
  void drift(double way) {
    for (std::size_t i = 0; i < spheres_.size(); ++i)
      spheres_.set_center(i, spheres_.center(i) + way * uniform_direction<D>(random_));
  }

  Spheres<D> spheres_;

 private:
  PartialGrid::EachAxis<bool> each_axis() const {
    PartialGrid::EachAxis<bool> repeats{};
    std::ranges::copy(repeats_, repeats.begin());
    return repeats;
  }

  std::array<bool, D> repeats_;
  Vector<D> edges_;
  Random random_{1, stream(Stream::test)};
};

template <int D>
void expect_complete_on_every_number_of_axes(double edge) {
  for (const bool images : {true, false}) {
    std::array<bool, D> repeats;
    repeats.fill(images);
    repeats[D - 1] = true;  // mixed
    Scatter<D> scatter(300, edge, repeats);
    for (int axes = PartialGrid::automatic; axes <= D; ++axes) scatter.expect_complete(scatter.grid(axes));
  }
}

TEST(PartialGrid, FindsWhatIsNearOnEveryNumberOfAxes) {
  expect_complete_on_every_number_of_axes<1>(50);
  expect_complete_on_every_number_of_axes<2>(4);
  expect_complete_on_every_number_of_axes<3>(3);
  expect_complete_on_every_number_of_axes<5>(2);
  expect_complete_on_every_number_of_axes<8>(1.2);
}

TEST(PartialGrid, FindsThemInABoxOfOneOrTwoCells) {
  expect_complete_on_every_number_of_axes<2>(0.7);
  expect_complete_on_every_number_of_axes<3>(1.1);
}

TEST(PartialGrid, FindsThemWhenTheyHaveMovedAndWhenNewOnesCome) {
  Scatter<3> scatter(200, 3, {true, true, false});
  PartialGrid grid = scatter.grid(2, 0.1);
  scatter.drift(0.1);
  grid.update(columns_of(scatter.spheres_.x));
  scatter.expect_complete(grid);
  for (int k = 0; k < 40; ++k) {
    scatter.spheres_.push_back(scatter.anywhere(), 0.15);
    grid.add(scatter.spheres_.center(scatter.spheres_.size() - 1).data(), 0.15);
  }
  EXPECT_EQ(grid.unsorted(), 40u);
  scatter.expect_complete(grid);
}

// Which are then found in chains, as they came.
TEST(PartialGrid, FindsManyNewOnesInTheirOrder) {
  for (const double edge : {0.7, 3.0})
    for (int axes = 0; axes <= 3; ++axes) {
      Scatter<3> scatter(50, edge, {true, false, true});
      PartialGrid grid = scatter.grid(axes, 0.1);
      for (int round = 0; round < 2; ++round) {
        for (int k = 0; k < 200; ++k) {
          scatter.spheres_.push_back(scatter.anywhere(), 0.15);
          grid.add(scatter.spheres_.center(scatter.spheres_.size() - 1).data(), 0.15);
        }
        scatter.drift(0.1);
        grid.update(columns_of(scatter.spheres_.x));
        scatter.expect_complete(grid);
        std::uint32_t last = 0;
        const auto sorted = static_cast<std::uint32_t>(grid.size() - grid.unsorted());
        grid.for_each_near(scatter.anywhere().data(), 0.3, [&](std::uint32_t id, double) {
          if (id < sorted) return;
          EXPECT_GT(id, last);
          last = id;
        });
        grid.sort(columns_of(scatter.spheres_.x), scatter.spheres_.r, scatter.spheres_.size());
        EXPECT_EQ(grid.unsorted(), 0u);
        scatter.expect_complete(grid);
      }
    }
}

// Few spheres are compared one by one; the more there are, the more axes pay.
TEST(PartialGrid, TakesMoreAxesTheMoreSpheresThereAre) {
  int before = 0;
  for (const double spheres : {10.0, 1e3, 1e5, 1e7}) {
    const double edge = 0.5 * std::pow(spheres, 1.0 / 5);
    PartialGrid grid(Vector<5>::Constant(edge), {true, true, true, true, true}, 0.5, 0,
                     static_cast<std::size_t>(spheres));
    EXPECT_GE(grid.axes(), before);
    before = grid.axes();
  }
  EXPECT_EQ(before, 5);
  PartialGrid few(Vector<5>::Constant(0.8), {true, true, true, true, true}, 0.5, 0, 10);
  EXPECT_EQ(few.axes(), 0);
}

}  // namespace partial_grid_test
}  // namespace bernal
