#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/plans.hpp"

// The endless column against a long closed cylinder of the same radius: away from its lids that does not know
// that it ends.
namespace bernal {
namespace column_test {

constexpr double radius = 5;         // of the column, in diameters
constexpr double block_height = 4;   // a sample: spheres hardly know of each other over such a distance
constexpr double lids = 5;           // as far as a lid's layers reach
constexpr std::size_t layers = 20;   // of equal thickness, from the wall to the axis
constexpr std::size_t points = 400;  // in each sphere

/// Along z from `from` to `to`, by layers across: of each block the volume of the spheres in each layer over
/// that of the layer.
struct Profile {
  std::vector<std::vector<double>> blocks;

  void add(const Packing& packing, double from, double to) {
    const double height = packing.domain.index() == 0 ? 0 : std::get<Cylinder>(packing.domain).height;
    const bool periodic = is_periodic(packing.domain);
    const auto count = static_cast<std::size_t>((to - from) / block_height);
    std::vector<std::vector<double>> filled(count, std::vector<double>(layers, 0));
    Random random(1, stream(Stream::test));
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      const double r = packing.spheres.r[i], share = 4.0 / 3 * std::numbers::pi * r * r * r / points;
      for (std::size_t k = 0; k < points; ++k) {
        const Vector<3> p =
            packing.spheres.center(i) + r * std::cbrt(random.uniform()) * uniform_direction<3>(random);
        double z = p[2];
        if (periodic) z -= height * std::floor(z / height);
        const double block = std::floor((z - from) / block_height);
        const double depth = radius - std::hypot(p[0], p[1]);
        if (block < 0 || block >= static_cast<double>(count) || depth < 0) continue;
        const auto layer = std::min(layers - 1, static_cast<std::size_t>(depth / radius * layers));
        filled[static_cast<std::size_t>(block)][layer] += share;
      }
    }
    for (std::vector<double>& block : filled) {
      for (std::size_t k = 0; k < layers; ++k) {
        const double outer = radius * (1 - static_cast<double>(k) / layers),
                     inner = radius * (1 - static_cast<double>(k + 1) / layers);
        block[k] /= std::numbers::pi * (outer * outer - inner * inner) * block_height;
      }
      blocks.push_back(std::move(block));
    }
  }

  double mean(std::size_t layer) const {
    double sum = 0;
    for (const auto& block : blocks) sum += block[layer];
    return sum / static_cast<double>(blocks.size());
  }
  /// Of the mean, from the scatter between blocks.
  double squared_error(std::size_t layer) const {
    const double middle = mean(layer);
    double sum = 0;
    for (const auto& block : blocks) sum += (block[layer] - middle) * (block[layer] - middle);
    const auto n = static_cast<double>(blocks.size());
    return sum / (n - 1) / n;
  }
};

Packing packed(double height, bool periodic, int seed, const std::string& stages) {
  const Plan plan = testing::plan_of(
      fmt::format("seed = {}\n[container]\nkind = \"cylinder\"\nradius = {}\nheight = {}\nperiodic = {}\n"
                  "[spheres]\nfill = true\ndiameter = 1.0\n",
                  seed, radius, height, periodic) +
      stages);
  Packing packing = run(plan);
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  return packing;
}

class Column : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

const char* const settled =
    "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\ndirection = [1, 0, 0]\n"
    "[[stage]]\ndo = \"refill\"\ndirection = [1, 0, 0]\n";
INSTANTIATE_TEST_SUITE_P(, Column,
                         ::testing::Values(std::pair("Relaxed", "[[stage]]\ndo = \"relax\"\n"),
                                           std::pair("Grown", "[[stage]]\ndo = \"grow\"\n"),
                                           std::pair("Settled", settled)),
                         [](const auto& tested) { return tested.param.first; });

/// Student's t with some twenty degrees of freedom is beyond 5 once in 30,000 times; twenty layers are looked
/// at. The whole is compared at 4.
TEST_P(Column, HasThePorosityProfileOfALongCylinder) {
  Profile column, closed;
  for (int seed = 1; seed <= 3; ++seed) {
    column.add(packed(16, true, seed, GetParam().second), 0, 16);
    closed.add(packed(16 + 2 * lids, false, seed, GetParam().second), lids, 16 + lids);
  }
  ASSERT_EQ(column.blocks.size(), 12u);
  ASSERT_EQ(closed.blocks.size(), 12u);
  double difference = 0, squared = 0;
  for (std::size_t k = 0; k < layers; ++k) {
    const double error = std::sqrt(column.squared_error(k) + closed.squared_error(k));
    EXPECT_NEAR(column.mean(k), closed.mean(k), 5 * error) << "layer " << k;
    const double outer = 1 - static_cast<double>(k) / layers, inner = outer - 1.0 / layers;
    const double share = outer * outer - inner * inner;
    difference += share * (column.mean(k) - closed.mean(k));
    squared += share * share * error * error;
    std::printf("%4.2f  %.4f  %.4f  %.4f\n", (static_cast<double>(k) + 0.5) * radius / layers,
                1 - column.mean(k), 1 - closed.mean(k), error);
    // Layers near the axis are thin; those that matter are known well.
    if (k < 3 * layers / 4) {
      EXPECT_LT(error, 0.02) << "layer " << k;
    }
  }
  std::printf("mean difference %.4f +- %.4f\n", difference, std::sqrt(squared));
  EXPECT_NEAR(difference, 0, 4 * std::sqrt(squared));
  EXPECT_LT(std::sqrt(squared), 0.004);
}

/// As many contacts go through the plane in which a period ends as through any other across the axis.
TEST_P(Column, TouchesItselfAcrossItsSeamAsElsewhere) {
  const double height = 16;
  const Packing packing = packed(height, true, 4, GetParam().second);
  const Boundary<3> boundary = boundary_of<3>(packing.domain);
  std::vector<int> through(32, 0);  // planes, evenly spaced; the first is the seam
  for (std::size_t i = 0; i < packing.spheres.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector<3> way = boundary.minimum_image(packing.spheres.center(j) - packing.spheres.center(i));
      if (way.norm() > 1.01) continue;
      const double from = packing.spheres.x[2][i], to = from + way[2];
      for (std::size_t k = 0; k < through.size(); ++k) {
        const double plane = height * static_cast<double>(k) / static_cast<double>(through.size());
        for (const double image : {-height, 0.0, height})
          through[k] += std::min(from, to) < plane + image && plane + image <= std::max(from, to);
      }
    }
  double mean = 0, variance = 0;
  for (std::size_t k = 1; k < through.size(); ++k) mean += through[k] / 31.0;
  for (std::size_t k = 1; k < through.size(); ++k) variance += (through[k] - mean) * (through[k] - mean) / 30;
  EXPECT_GT(through[0], 0);
  EXPECT_NEAR(through[0], mean, 4 * std::sqrt(variance)) << "scatter " << std::sqrt(variance);
  EXPECT_GT(mean, 100);
}

}  // namespace column_test
}  // namespace bernal
