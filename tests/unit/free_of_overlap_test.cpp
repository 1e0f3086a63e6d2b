#include "work/free_of_overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "support/nearest_images.hpp"

// How far a box must grow: against all pairs, and proved with rational numbers.
namespace bernal {
namespace free_of_overlap_test {

template <class Dimension>
class FreeOfOverlap : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 1>, std::integral_constant<int, 2>,
                                    std::integral_constant<int, 3>, std::integral_constant<int, 4>,
                                    std::integral_constant<int, 8>>;
TYPED_TEST_SUITE(FreeOfOverlap, Dimensions);

/// The factor is that of all pairs, to rounding, and the box that follows is free of overlap.
template <int D>
void expect_free(Spheres<D> spheres, Vector<D> edges) {
  const double factor = contact_factor(spheres, edges);
  EXPECT_NEAR(factor, oracle::contact_factor(spheres, edges), 1e-13 * factor);
  const Vector<D> free = edges_free_of_overlap(spheres, edges);
  // No larger than it need be: the growth for rounding is relative to the smallest sphere.
  const double smallest = std::ranges::min(spheres.r);
  EXPECT_LE((free.cwiseQuotient(edges) / factor).maxCoeff(), 1 + 1e-14 * free.maxCoeff() / smallest);
  resize_box<D>(spheres, edges, free);
  EXPECT_TRUE(oracle::centers_in_box(spheres, edges));
  EXPECT_EQ(oracle::overlapping_pairs(spheres, edges), 0u);
}

TYPED_TEST(FreeOfOverlap, EqualSpheres) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(3);
  expect_free<D>(oracle::anywhere<D>(100, 0.1, 0.1, edges, 1), edges);
}

TYPED_TEST(FreeOfOverlap, SpheresOfWidelyDifferentSizes) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(7);
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    expect_free<D>(oracle::anywhere<D>(100, 1e-3, 1, edges, seed), edges);
}

TYPED_TEST(FreeOfOverlap, SpheresFarApart) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(7);
  expect_free<D>(oracle::anywhere<D>(100, 1e-6, 1e-5, edges, 1), edges);
  expect_free<D>(oracle::anywhere<D>(2, 1e-6, 1e-3, edges, 1), edges);
}

TYPED_TEST(FreeOfOverlap, FewSpheresInABoxNotMuchLarger) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(2.5);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expect_free<D>(oracle::anywhere<D>(1, 1, 1, edges, seed), edges);
    expect_free<D>(oracle::anywhere<D>(2, 0.5, 1, edges, seed), edges);
    expect_free<D>(oracle::anywhere<D>(5, 0.5, 1, edges, seed), edges);
  }
}

TYPED_TEST(FreeOfOverlap, UnequalEdges) {
  constexpr int D = TypeParam::value;
  Vector<D> edges = Vector<D>::Constant(2.5);
  edges[D - 1] = 40;
  expect_free<D>(oracle::anywhere<D>(50, 0.1, 1, edges, 1), edges);
}

// The growth is by 1e5: rounding counts in the coordinates of the grown box.
TYPED_TEST(FreeOfOverlap, SpheresAlmostAtOnePlace) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(10);
  Spheres<D> spheres = oracle::anywhere<D>(10, 0.5, 1, edges, 1);
  for (std::size_t i = 0; i < spheres.size(); ++i)
    spheres.set_center(i, Vector<D>::Constant(5) + 1e-6 * spheres.center(i));
  expect_free<D>(spheres, edges);
}

TYPED_TEST(FreeOfOverlap, AcrossTheFacesOfTheBox) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(10);
  Spheres<D> spheres;
  spheres.push_back(Vector<D>::Constant(0.1), 1);
  spheres.push_back(Vector<D>::Constant(9.9), 1);
  EXPECT_NEAR(contact_factor(spheres, edges), 2 / (0.2 * std::sqrt(D)), 1e-12);
  expect_free<D>(spheres, edges);
}

TYPED_TEST(FreeOfOverlap, NoBoxIsLargeEnoughForCoincidentCentres) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(10);
  Spheres<D> spheres = oracle::anywhere<D>(10, 0.5, 1, edges, 1);
  spheres.set_center(3, spheres.center(7));
  EXPECT_EQ(contact_factor(spheres, edges), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(edges_free_of_overlap(spheres, edges).allFinite());
}

TEST(AllowedOverlap, IsLeft) {
  const Vector<3> edges = Vector<3>::Constant(10);
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 1);
  spheres.push_back({2.9, 1, 1}, 1);  // overlap ratio 0.05
  const auto growth = [&](double allowed) { return edges_free_of_overlap(spheres, edges, allowed)[0] / 10; };
  EXPECT_NEAR(growth(0), 1 / 0.95, 1e-12);
  EXPECT_NEAR(growth(0.03), 0.97 / 0.95, 1e-12);
  EXPECT_NEAR(growth(0.05), 1, 1e-12);
  EXPECT_NEAR(growth(0.20), 1, 1e-12);  // it is not pressed together
  spheres.set_center(1, {5, 1, 1});
  EXPECT_NEAR(growth(0), 0.5, 1e-12);
  EXPECT_NEAR(growth(0.20), 0.5, 1e-12);
}

TEST(ResizeBox, KeepsCentresInTheBox) {
  const Vector<3> edges{1.0, 2.0, 3.0}, larger{1.1, 2.2, 3.3};
  Spheres<3> spheres;
  spheres.push_back({std::nextafter(1.0, 0.0), std::nextafter(2.0, 0.0), std::nextafter(3.0, 0.0)}, 0.1);
  spheres.push_back({0, 1, 1.5}, 0.1);
  Vector<3> box = edges;
  resize_box<3>(spheres, box, larger);
  EXPECT_EQ(box, larger);
  EXPECT_TRUE(oracle::centers_in_box(spheres, box));
  EXPECT_LE((spheres.center(1) - Vector<3>(0, 1.1, 1.65)).norm(), 1e-15);
}

// Of displacements a tenth apart, every image within reach, and none twice.
TEST(Boundary, VisitsAllImagesWithinReach) {
  const Boundary<2> boundary{{1.0, 2.5}};
  for (const double reach : {0.3, 0.5, 1.0, 3.2}) {
    for (int a = -10; a <= 10; ++a) {
      for (int b = -25; b <= 25; ++b) {
        const Vector<2> d{a / 10.0 + 0.01, b / 10.0 + 0.01};
        int expected = 0, visited = 0;
        for (int m = -8; m <= 8; ++m)
          for (int n = -8; n <= 8; ++n)
            expected += std::max(std::abs(d[0] + m), std::abs(d[1] + 2.5 * n)) < reach ? 1 : 0;
        boundary.for_each_image(d, reach, [&](const Vector<2>& image) {
          EXPECT_LE(image.cwiseAbs().maxCoeff(), reach + 1e-12);
          const double turns = (image[0] - d[0]) / 1.0, other_turns = (image[1] - d[1]) / 2.5;
          EXPECT_NEAR(turns, std::round(turns), 1e-12);
          EXPECT_NEAR(other_turns, std::round(other_turns), 1e-12);
          ++visited;
        });
        EXPECT_EQ(visited, expected) << d.transpose() << " within " << reach;
      }
    }
  }
}

TEST(IsFreeOfOverlap, IsDecidedExactly) {
  const Vector<3> edges(10, 10, 10);
  const std::vector<bool> walls = {false, false, true};
  const auto is_free = [&](double x, double z, const std::vector<bool>& ends) {
    Spheres<3> spheres;
    spheres.push_back(Vector<3>(9.5, 2, z), 1);
    spheres.push_back(Vector<3>(x, 2, 5), 1);
    return is_free_of_overlap<3>(spheres, edges, ends);
  };
  EXPECT_TRUE(is_free(1.5, 5, {}));  // they touch, across the seam
  EXPECT_FALSE(is_free(std::nextafter(1.5, 0), 5, {}));
  EXPECT_TRUE(is_free(5, 1, walls));
  EXPECT_FALSE(is_free(5, std::nextafter(1, 0), walls));
  EXPECT_TRUE(is_free(5, 9, walls));
  EXPECT_FALSE(is_free(5, std::nextafter(9, 10), walls));
}

/// Near the points of a lattice, so that who is near whom is known; in any order.
template <int D>
struct Lattice {
  int edge;
  Spheres<D> spheres;
  std::vector<std::uint32_t> at;  ///< the sphere of each point

  Lattice(int points, double farthest, double smallest, std::uint64_t seed) : edge(points) {
    Random random(seed, stream(Stream::test));
    std::size_t n = 1;
    for (int k = 0; k < D; ++k) n *= static_cast<std::size_t>(points);
    at.resize(n);
    std::iota(at.begin(), at.end(), 0u);
    for (std::size_t i = n - 1; i > 0; --i) std::swap(at[i], at[random() % (i + 1)]);
    spheres.resize(n);
    const Boundary<D> boundary{Vector<D>::Constant(points)};
    for (std::size_t p = 0; p < n; ++p) {
      Vector<D> c;
      std::size_t rest = p;
      for (int k = 0; k < D; ++k, rest /= static_cast<std::size_t>(points))
        c[k] = static_cast<double>(rest % static_cast<std::size_t>(points)) +
               random.uniform(-farthest, farthest);
      spheres.set_center(at[p], boundary.wrap(c));
      spheres.r[at[p]] = random.uniform(smallest, 0.5);
    }
  }

  double contact_factor_of_neighbours() const {
    const Boundary<D> boundary{Vector<D>::Constant(edge)};
    double factor = 2 * std::ranges::max(spheres.r) / edge;
    int around = 1;
    for (int k = 0; k < D; ++k) around *= 3;
    for (std::size_t p = 0; p < at.size(); ++p)
      for (int a = 0; a < around; ++a) {
        std::size_t other = 0, weight = 1, rest = p;
        for (int k = 0, way = a; k < D; ++k, way /= 3, rest /= static_cast<std::size_t>(edge)) {
          other += weight *
                   ((rest % static_cast<std::size_t>(edge) + static_cast<std::size_t>(edge + way % 3 - 1)) %
                    static_cast<std::size_t>(edge));
          weight *= static_cast<std::size_t>(edge);
        }
        if (other == p) continue;
        const Vector<D> d = spheres.center(at[p]) - spheres.center(at[other]);
        factor =
            std::max(factor, (spheres.r[at[p]] + spheres.r[at[other]]) / boundary.minimum_image(d).norm());
      }
    return factor;
  }
};

// So many spheres are looked at in threads: the same number to the bit, wherever the worst pair is.
TEST(FreeOfOverlapInThreads, IsThatOfAllPairs) {
  for (const double smallest : {0.5, 0.1}) {
    Lattice<3> lattice(70, 0.05, smallest, 1);
    const Vector<3> edges = Vector<3>::Constant(70);
    EXPECT_EQ(contact_factor(lattice.spheres, edges), lattice.contact_factor_of_neighbours());
    for (const double x : {0.01, 17.4, 34.99, 69.9}) {  // across faces of the box and anywhere else
      Spheres<3> close = lattice.spheres;
      close.set_center(5, Vector<3>(x, x, 3e-5));
      close.set_center(77, Vector<3>(x, x, 70 - 6e-5));
      const double factor = (close.r[5] + close.r[77]) / 9e-5;
      EXPECT_NEAR(contact_factor(close, edges), factor, 1e-6 * factor);
    }
  }
  const Lattice<2> discs(600, 0.1, 0.3, 2);
  EXPECT_EQ(contact_factor(discs.spheres, Vector<2>(Vector<2>::Constant(600))),
            discs.contact_factor_of_neighbours());
}

TEST(FreeOfOverlapInThreads, KnowsSpheresThatAreFarApart) {
  Lattice<3> lattice(70, 0.01, 0.5, 3);
  for (double& r : lattice.spheres.r) r *= 0.2;
  EXPECT_EQ(contact_factor(lattice.spheres, Vector<3>(Vector<3>::Constant(70))),
            lattice.contact_factor_of_neighbours());
}

TEST(FreeOfOverlapInThreads, KnowsCentresThatCoincide) {
  Lattice<3> lattice(70, 0.01, 0.5, 4);
  lattice.spheres.set_center(1000, lattice.spheres.center(200'000));
  EXPECT_EQ(contact_factor(lattice.spheres, Vector<3>(Vector<3>::Constant(70))),
            std::numeric_limits<double>::infinity());
}

}  // namespace free_of_overlap_test
}  // namespace bernal
