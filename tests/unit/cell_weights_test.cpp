// Weights for which the cells of a power diagram have given volumes.
#include "bernal/measure/cell_weights.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/local_packing.hpp"
#include "measure/weighted_cells.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace cell_weights_test {

using testing::scattered;

const Bounds<3> unit_cube{Vector<3>::Zero(), Vector<3>::Ones()};

Box box_of(const Vector<3>& size, std::vector<bool> periodic) {
  Box box;
  box.size = size;
  box.periodic = std::move(periodic);
  return box;
}
Box periodic_cube() { return box_of(Vector<3>::Ones(), {true, true, true}); }

/// Lognormal, with this standard deviation of the logarithm of the diameters.
std::vector<double> lognormal_volumes(std::size_t n, double sigma, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  std::vector<double> volumes;
  while (volumes.size() < n) {
    const double u = 1 - random.uniform(), v = random.uniform();
    const double normal = std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
    volumes.push_back(std::exp(3 * sigma * normal));
  }
  return volumes;
}

std::vector<double> scaled_to(std::vector<double> volumes, double sum) {
  const double scale = sum / std::accumulate(volumes.begin(), volumes.end(), 0.0);
  for (double& volume : volumes) volume *= scale;
  return volumes;
}

// Two slabs: the planes between centres that are 1/2 apart, on both sides, move by the difference of the
// weights each.
TEST(CellWeights, OfTwoSlabsAreKnown) {
  Spheres<dynamic> spheres;
  spheres.push_back(Vector<3>(0.25, 0.5, 0.5), 0.2);
  spheres.push_back(Vector<3>(0.75, 0.5, 0.5), 0.1);
  for (const double share : {0.5, 0.7, 0.05, 0.999}) {
    const CellWeights found = weights_for_volumes(spheres, periodic_cube(), std::vector{share, 1 - share});
    EXPECT_NEAR(found.weights[0] - found.weights[1], 0.5 * (share - 0.5), 1e-12) << share;
    EXPECT_NEAR(found.volumes[0], share, 1e-11);
    EXPECT_NEAR(found.weights[0] + found.weights[1], 0.04 + 0.01, 1e-14) << "the mean is that of r²";
    EXPECT_NEAR(found.sphericity[0], std::cbrt(36 * std::numbers::pi * share * share) / (2 + 4 * share),
                1e-11);
  }
}

// In a box between walls only one plane moves.
TEST(CellWeights, OfTwoCellsBetweenWallsAreKnown) {
  Spheres<dynamic> spheres;
  spheres.push_back(Vector<3>(0.5, 0.5, 0.5), 0.2);
  spheres.push_back(Vector<3>(1.5, 0.5, 0.5), 0.2);
  const CellWeights found = weights_for_volumes(spheres, box_of({2, 1, 1}, {}), std::vector{3.0, 1.0});
  EXPECT_NEAR(found.volumes[0], 1.5, 1e-10);  // of the box, in proportion
  EXPECT_NEAR(found.weights[0] - found.weights[1], 1.0, 1e-10);
}

TEST(CellWeights, SlopesOfVolumesAreDifferencesOfVolumes) {
  const Spheres<3> spheres = scattered(25, 0.02, 0.12, unit_cube, 3);
  std::vector<double> weights;
  for (const double r : spheres.r) weights.push_back(r * r);
  for (const Vector<3>& periods : {Vector<3>(1, 1, 1), Vector<3>(0, 0, 0), Vector<3>(1, 0, 1)}) {
    const CellBox box{3, unit_cube, Boundary<3>{periods, Vector<3>::Zero()}};
    const WeightedCells cells = weighted_cells(spheres, box, weights);
    EXPECT_NEAR(std::accumulate(cells.volumes.begin(), cells.volumes.end(), 0.0), 1, 1e-12);
    constexpr double step = 1e-5;
    for (std::size_t j = 0; j < spheres.size(); ++j) {
      std::vector<double> more = weights, less = weights;
      more[j] += step;
      less[j] -= step;
      const WeightedCells above = weighted_cells(spheres, box, more),
                          below = weighted_cells(spheres, box, less);
      double own = 0;
      for (std::size_t i = 0; i < spheres.size(); ++i) {
        const double difference = (above.volumes[i] - below.volumes[i]) / (2 * step);
        double slope = 0;
        for (const auto& [neighbour, of_face] : cells.slopes[i])
          if (neighbour == j) slope -= of_face;
        if (i == j)
          for (const auto& [neighbour, of_face] : cells.slopes[i]) slope += of_face;
        EXPECT_NEAR(difference, slope, 2e-6) << i << " " << j << " " << periods.transpose();
        own += difference;
      }
      EXPECT_NEAR(own, 0, 1e-9);
    }
  }
}

TEST(CellWeights, VolumesAreThoseThatAreWanted) {
  struct Case {
    std::size_t n;
    double sigma;
    std::vector<bool> periodic;
  };
  for (const auto& [n, sigma, periodic] : std::vector<Case>{{1, 0, {true, true, true}},
                                                            {40, 0, {true, true, true}},
                                                            {40, 0.5, {}},
                                                            {300, 0.35, {true, true, true}},
                                                            {300, 0.35, {}},
                                                            {300, 0.35, {true, false, true}}}) {
    const Spheres<dynamic> spheres = scattered(n, 0.005, 0.1, unit_cube, 5);
    const Box box = box_of(Vector<3>::Ones(), periodic);
    const std::vector<double> wanted = scaled_to(lognormal_volumes(spheres.size(), sigma, 1), 1);
    const CellWeights found = weights_for_volumes(spheres, box, wanted);
    const LocalPacking local = local_packing(with_weights(spheres, found.weights), box).value();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      EXPECT_NEAR(local.cell_volume[i], wanted[i], 1e-10 * wanted[i]) << n << " " << i;
      EXPECT_NEAR(found.volumes[i], wanted[i], 1e-10 * wanted[i]);
      EXPECT_GT(found.sphericity[i], 0.2);
      EXPECT_LT(found.sphericity[i], 1);
    }
    EXPECT_LE(found.steps, 15) << n << " " << sigma;
  }
}

// By the definition: random points, each of which belongs to the centre of the least power.
TEST(CellWeights, CellsAreWhereThePowerIsLeast) {
  const Spheres<dynamic> spheres = scattered(30, 0.02, 0.1, unit_cube, 8);
  const std::vector<double> wanted = scaled_to(lognormal_volumes(spheres.size(), 0.3, 2), 1);
  const CellWeights found = weights_for_volumes(spheres, periodic_cube(), wanted);
  constexpr std::size_t points = 100'000;
  std::vector<double> counts(spheres.size(), 0);
  Random random(9, stream(Stream::test));
  for (std::size_t k = 0; k < points; ++k) {
    const Vector<3> p = uniform_point(random, unit_cube);
    std::size_t nearest = 0;
    double least = 1e9;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      Vector<3> d = p - Vector<3>(spheres.center(i));
      for (int axis = 0; axis < 3; ++axis) d[axis] -= std::nearbyint(d[axis]);
      if (const double power = d.squaredNorm() - found.weights[i]; power < least) least = power, nearest = i;
    }
    ++counts[nearest];
  }
  for (std::size_t i = 0; i < spheres.size(); ++i)
    EXPECT_NEAR(counts[i] / points, wanted[i], 5 * std::sqrt(wanted[i] / points)) << i;
}

TEST(CellWeights, AreTheSameInAnyUnitAndFarAway) {
  const Spheres<dynamic> spheres = scattered(60, 0.01, 0.1, unit_cube, 4);
  const std::vector<double> wanted = lognormal_volumes(spheres.size(), 0.3, 3);
  const CellWeights there = weights_for_volumes(spheres, periodic_cube(), wanted);
  constexpr double unit = 1e-6;
  Spheres<dynamic> small = spheres;
  for (auto& column : small.x)
    for (double& x : column) x = unit * (x + 100);
  for (double& r : small.r) r *= unit;
  Box box = periodic_cube();
  box.size *= unit;
  box.corner = Vector<3>::Constant(100 * unit);
  const CellWeights far = weights_for_volumes(small, box, wanted);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    EXPECT_NEAR(far.weights[i], unit * unit * there.weights[i], 1e-11 * unit * unit);
    EXPECT_NEAR(far.volumes[i], unit * unit * unit * there.volumes[i], 1e-10 * unit * unit * unit);
  }
}

TEST(CellWeights, AreTheSameToTheBitInAnyNumberOfThreads) {
  const Spheres<dynamic> spheres = scattered(300, 0.005, 0.1, unit_cube, 6);
  const std::vector<double> wanted = lognormal_volumes(spheres.size(), 0.35, 4);
  const auto with = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return weights_for_volumes(spheres, periodic_cube(), wanted).weights;
  };
  const std::vector<double> one = with(1);
  EXPECT_EQ(with(2), one);
  EXPECT_EQ(with(5), one);
}

TEST(CellWeights, NothingElseIsAccepted) {
  const Spheres<dynamic> two = scattered(2, 0.1, 0.1, unit_cube, 1);
  const auto refused = [](const Spheres<dynamic>& spheres, const Domain& domain,
                          const std::vector<double>& volumes) -> std::string {
    try {
      weights_for_volumes(spheres, domain, volumes);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      return error.what();
    }
    return "";
  };
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  says(refused(two, Cylinder{}, {1, 1}), "boxes of three dimensions");
  says(refused(two, periodic_cube(), {1}), "a volume for each of 2 spheres, not 1");
  says(refused(two, periodic_cube(), {1, -1}), "must be positive, not -1");
  says(refused(two, periodic_cube(), {1, 0}), "must be positive, not 0");
  Spheres<dynamic> hidden = two;  // in the other, so that it has no cell
  hidden.push_back(two.center(0) + Vector<3>(0.002, 0, 0), 0.001);
  says(refused(hidden, periodic_cube(), {1, 1, 1}), "no cell");
}

}  // namespace cell_weights_test
}  // namespace bernal
