#include <gtest/gtest.h>

#include <cmath>

#include "bernal/core/boundary.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "soft/device_packing.hpp"
#include "soft/growing_box.hpp"
#include "soft/soft_packing.hpp"
#include "support/host_device.hpp"
#include "support/refusals.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace device_packing_test {

struct InBox {
  Spheres<3> spheres;
  Vector<3> edges;
};

/// Spheres at random in a box of those proportions that they fill, overlaps counted twice, to `phi`.
InBox at_random(std::size_t n, double phi, Vector<3> proportions, double r_min, double r_max,
                std::uint64_t seed = 5) {
  InBox box{.spheres = {}, .edges = proportions};
  Random random(seed, stream(Stream::test));
  double volume = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double r = r_min + (r_max - r_min) * random.uniform();
    box.spheres.push_back(Vector<3>::Zero(), r);
    volume += 4.0 / 3 * M_PI * r * r * r;
  }
  box.edges *= std::cbrt(volume / phi / proportions.prod());
  for (std::size_t i = 0; i < n; ++i)
    box.spheres.set_center(i, uniform_point(random, Bounds<3>{Vector<3>::Zero(), box.edges}));
  return box;
}

DevicePacking on_host(const InBox& box, std::size_t window = 100) {
  return {box.spheres, box.edges, std::make_unique<ColouredSpheres<HostDevice>>(window)};
}

Spheres<3> places_of(const DevicePacking& packing, const InBox& box) {
  Spheres<3> spheres = box.spheres;
  Vector<3> edges;
  packing.write_to(spheres, edges);
  return spheres;
}

/// All that touch nothing are moved by nothing, and two that touch come apart as the paper says.
TEST(DevicePacking, MovesTwoSpheresUntilTheyJustTouch) {
  InBox box{.spheres = {}, .edges = {40, 44, 48}};
  box.spheres.push_back({39.5, 1, 2}, 1.0);
  box.spheres.push_back({0.5, 1, 2}, 2.0);  // across the border
  box.spheres.push_back({20, 20, 20}, 1.5);
  DevicePacking packing = on_host(box);
  EXPECT_NEAR(packing.sweep_to_overlap(1), 2.0 / 3, 1e-6);
  const Spheres<3> after = places_of(packing, box);
  const Boundary<3> boundary{box.edges};
  EXPECT_NEAR(boundary.minimum_image(after.center(0) - after.center(1)).norm(), 3, 1e-5);
  EXPECT_NEAR((after.center(2) - box.spheres.center(2)).norm(), 0, 1e-7);
}

/// A sweep on lists is one over all pairs that were near each other when these were built, in the same order:
/// of colours, cells, and spheres in these. (Crowded spheres move farther in it than the skin.)
TEST(DevicePacking, SweepsAsAllPairsDo) {
  for (const auto& [proportions, n] : {std::pair{Vector<3>(1, 1, 1), 400}, {Vector<3>(1, 2, 1.5), 1500}}) {
    const InBox box = at_random(static_cast<std::size_t>(n), 0.7, proportions, 0.7, 1.3);
    DevicePacking packing = on_host(box, 1 << 20);
    const double met = packing.sweep_to_overlap(5);

    const double skin = SoftPacking::usual_skin(box.spheres.r), largest = std::ranges::max(box.spheres.r);
    Eigen::Array3i across;
    for (int k = 0; k < 3; ++k) across[k] = 2 * static_cast<int>(box.edges[k] / (4 * (largest + skin)));
    const auto rank = [&](std::uint32_t i) {
      const Eigen::Array3i at =
          (box.spheres.center(i).array() / box.edges.array() * across.cast<double>()).floor().cast<int>();
      const int colour = at[0] % 2 + 2 * (at[1] % 2) + 4 * (at[2] % 2);
      return std::tuple(colour, at[2], at[1], at[0], i);
    };
    std::vector<std::uint32_t> order(box.spheres.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, rank);

    Spheres<3> by_pairs = box.spheres;
    const Boundary<3> boundary{box.edges};
    const auto were_apart = [&](std::uint32_t i, std::uint32_t j) {
      return boundary.minimum_image(box.spheres.center(i) - box.spheres.center(j)).norm();
    };
    double worst = 0;
    for (const std::uint32_t i : order) {
      Vector<3> sum = Vector<3>::Zero();
      double contacts = 0;
      for (std::uint32_t j = 0; j < by_pairs.size(); ++j) {
        const Vector<3> way = boundary.minimum_image(by_pairs.center(i) - by_pairs.center(j));
        const double reach = by_pairs.r[i] + by_pairs.r[j], d = way.norm();
        if (i == j || d >= reach || were_apart(i, j) >= reach + 2 * skin) continue;
        const double weight = 2 * by_pairs.r[j] / reach;
        sum += weight * (reach - d) / d * way;
        contacts += weight;
        worst = std::max(worst, (reach - d) / reach);
      }
      if (contacts > 0) by_pairs.set_center(i, by_pairs.center(i) + std::min(1.0, 5 / contacts) * sum);
    }
    EXPECT_NEAR(met, worst, 1e-5);
    const Spheres<3> after = places_of(packing, box);
    for (std::uint32_t i = 0; i < after.size(); ++i)
      ASSERT_LT(boundary.minimum_image(after.center(i) - by_pairs.center(i)).norm(), 2e-4) << i;
  }
}

/// Whatever the window of layers that is swept at a time, and however often lists are built.
TEST(DevicePacking, PacksAsDenselyAsTheProcessor) {
  const GrowingBox growing{.stop = 1e-5, .sweeps = 24, .beta = 30};
  const auto fraction = [&](auto& packing, const InBox& box) {
    BoxGrowth growth;
    const StageEnd end = grow_apart<3>(
        packing, growing, growth, [] { return false; }, [](int, double molr) { return molr; },
        [](double, double) {});
    EXPECT_EQ(end, StageEnd::converged);
    Spheres<3> spheres = box.spheres;
    Vector<3> edges;
    packing.write_to(spheres, edges);
    const Vector<3> free = edges_free_of_overlap<3>(spheres, edges);
    EXPECT_LT(free[0] / edges[0], 1 + 2e-5);
    double volume = 0;
    for (const double r : spheres.r) volume += 4.0 / 3 * M_PI * r * r * r;
    return volume / free.prod();
  };
  constexpr int seeds = 4;
  for (const double widest : {1.0, 2.0}) {
    double here = 0, there = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const InBox box = at_random(1500, 0.86, {1, 1, 1}, 1, widest, seed);
      SoftPacking soft(box.spheres, box.edges, soft_kernels().front());
      DevicePacking coloured = on_host(box, 300 + 500 * seed);
      here += fraction(soft, box) / seeds;
      there += fraction(coloured, box) / seeds;
    }
    // A packing of 1,500 scatters by 0.0025, the mean of four by half of that; the difference by 1.4 times.
    EXPECT_NEAR(there, here, 4 * 1.4 * 0.0025 / std::sqrt(seeds)) << widest;
  }
}

TEST(DevicePacking, GoesOnToTheSameBits) {
  const InBox box = at_random(900, 0.8, {1, 1.2, 1}, 1, 1.5);
  DevicePacking whole = on_host(box), begun = on_host(box), resumed = on_host(box);
  const auto run = [](DevicePacking& packing, int sweeps) {
    for (int k = 0; k < sweeps; ++k) {
      packing.sweep(5);
      if (k % 7 == 6) packing.grow(1.002);
    }
  };
  run(whole, 56);
  run(begun, 28);
  std::string bytes;
  ArchiveToBytes out(bytes);
  begun.archive(out);
  ArchiveFromBytes in(bytes);
  resumed.archive(in);
  run(resumed, 28);
  EXPECT_EQ(places_of(resumed, box), places_of(whole, box));
}

TEST(DevicePacking, RefusesABoxInWhichCellsMeetTheirOwnImages) {
  const InBox box = at_random(200, 0.86, {1, 1, 1}, 1, 1);
  try {
    on_host(box);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("leave \"device\" out"), std::string::npos) << error.what();
  }
}

/// Where there is a GPU.
TEST(DevicePacking, IsTheSameOnAGpuToTheBit) {
  std::unique_ptr<DeviceSpheres> gpu;
  try {
    gpu = spheres_on_gpu();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  const InBox box = at_random(20000, 0.8, {1, 1.2, 1}, 1, 1.5);
  DevicePacking there(box.spheres, box.edges, std::move(gpu));
  DevicePacking here = on_host(box, ColouredSpheres<HostDevice>::usual_window);
  for (int k = 0; k < 60; ++k) {
    there.sweep(5);
    here.sweep(5);
    if (k % 10 == 9) {
      EXPECT_EQ(there.sweep_to_overlap(4), here.sweep_to_overlap(4));
    }
    if (k % 7 == 6) there.grow(1.003), here.grow(1.003);
  }
  EXPECT_EQ(places_of(there, box), places_of(here, box));
}

TEST(RelaxOnAGpu, IsRefusedForWhatOnlyTheProcessorDoes) {
  const auto refusal = [](const std::string& container, const std::string& sizes,
                          const std::string& more = "") {
    return testing::error_of("unit = \"mm\"\n[container]\n" + container + "\n[spheres]\ncount = 500\n" +
                             sizes + "\n[[stage]]\ndo = \"relax\"\ndevice = \"gpu\"\n" + more);
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::string cube = "kind = \"periodic\"", equal = "diameter = 1";
  contains(refusal(cube + "\ndimension = 2", equal), "three dimensions only");
  contains(refusal(cube, equal, "method = \"reference\""), "no \"method\" but fast");
  contains(refusal(cube, "diameter = {distribution = \"lognormal\", median = 1, sigma = 0.9}"),
           "no sizes as wide");
  contains(refusal("kind = \"box\"\nsize = [9, 9, 9]", equal), "device");
}

}  // namespace device_packing_test
}  // namespace bernal
