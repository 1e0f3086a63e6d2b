#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "hard/shells.hpp"

namespace bernal {
namespace shells_test {

template <int D>
struct Homes {
  std::vector<Vector<D>> homes;
  std::vector<double> radii, freedoms;
  Vector<D> edges = Vector<D>::LinSpaced(6, 8);
  Random random{3, stream(Stream::test)};

  Homes(std::size_t n, double least, double most) {
    for (std::size_t i = 0; i < n; ++i) {
      homes.push_back(somewhere());
      radii.push_back(least * std::pow(most / least, random.uniform()));
      freedoms.push_back(random.uniform(0.05, 0.2));
    }
  }
  Vector<D> somewhere() { return uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges}); }

  /// All pairs, and those that are no farther than `more` beyond.
  std::vector<std::uint32_t> neighbors_of(std::uint32_t i, double more = 0) const {
    const Boundary<D> boundary{edges};
    std::vector<std::uint32_t> found;
    for (std::uint32_t j = 0; j < homes.size(); ++j) {
      const double reach = radii[i] + freedoms[i] + radii[j] + freedoms[j] + more;
      if (j != i && boundary.minimum_image(homes[i] - homes[j]).norm() < reach) found.push_back(j);
    }
    return found;
  }
};

template <int D>
void expect_all_lists(const Shells<D>& shells, const Homes<D>& homes) {
  for (std::uint32_t i = 0; i < homes.homes.size(); ++i) {
    const auto list = shells.neighbors(i);
    std::vector<std::uint32_t> sorted(list.begin(), list.end());
    std::ranges::sort(sorted);
    const auto least = homes.neighbors_of(i);
    const auto most = homes.neighbors_of(i, HomeGrid<D>::coarseness * homes.edges.maxCoeff());
    ASSERT_TRUE(std::ranges::includes(sorted, least)) << "sphere " << i;
    ASSERT_TRUE(std::ranges::includes(most, sorted)) << "sphere " << i;
  }
}

template <int D>
void settle_here_and_there(Homes<D> homes) {
  Shells<D> shells;
  shells.build(homes.homes, homes.radii, homes.freedoms, homes.edges);
  expect_all_lists(shells, homes);
  for (int round = 0; round < 3; ++round) {
    for (std::uint32_t i = 0; i < homes.homes.size(); i += 2) {
      homes.homes[i] = homes.somewhere();
      shells.settle(i, homes.homes[i]);
    }
    expect_all_lists(shells, homes);
  }
  // All in one corner: cells with many points, which go again.
  for (const double width : {0.5, 1.0}) {
    for (std::uint32_t i = 0; i < homes.homes.size(); ++i) {
      homes.homes[i] = width * homes.somewhere();
      shells.settle(i, homes.homes[i]);
    }
    expect_all_lists(shells, homes);
  }
}

TEST(Shells, ListThoseWhoseReachesMeet) {
  settle_here_and_there(Homes<2>(200, 0.2, 0.4));
  settle_here_and_there(Homes<3>(300, 0.3, 0.5));
  settle_here_and_there(Homes<4>(200, 0.5, 0.7));
}

TEST(Shells, ListThemWhereSizesDifferTwentyfold) { settle_here_and_there(Homes<3>(600, 0.05, 1.0)); }

}  // namespace shells_test
}  // namespace bernal
