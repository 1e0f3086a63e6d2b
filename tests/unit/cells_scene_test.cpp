// Scenes that ask for volumes of the cells of their packings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "bernal/measure/cell_weights.hpp"
#include "bernal/measure/local_packing.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/packing_bytes.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace cells_scene_test {

const std::string periodic = "[container]\nkind = \"periodic\"\n";
const std::string lognormal =
    "cells = { diameter = { distribution = \"lognormal\", median = 1.0, sigma = 0.35, basis = \"number\" } "
    "}\n";

Scene scene_of(const std::string& container, const std::string& spheres) {
  return parse_scene(container + "[spheres]\n" + spheres, "s.toml");
}

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

/// As `measure` has them, where the weights are radii.
std::vector<double> cells_of(const Packing& packing) {
  return local_packing(with_weights(packing.spheres, packing.weights), packing.domain)->cell_volume;
}

double standard_normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

// The distance is computed here from the closed form, of cells that `measure` cuts.
TEST(Cells, HaveTheDistributionThatIsWanted) {
  const Packing packing = run(build(scene_of(periodic, "count = 1000\n" + lognormal)));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  const std::vector<double> volumes = sorted(cells_of(packing));
  ASSERT_EQ(volumes.size(), 1000u);
  const PackedCells& cells = packing.cells.value();
  double distance = 0;
  for (std::size_t k = 0; k < volumes.size(); ++k) {
    const double diameter = std::cbrt(6 / std::numbers::pi * volumes[k] / cells.scale);
    const double below = standard_normal_below(std::log(diameter) / 0.35), n = 1000;
    distance = std::max({distance, std::abs(below - static_cast<double>(k) / n),
                         std::abs(below - static_cast<double>(k + 1) / n)});
  }
  EXPECT_LE(distance, 0.0006);  // 1/(2n), and rounding
  EXPECT_NEAR(cells.distance, distance, 1e-6);
  EXPECT_LE(cells.distance_by_radii, 0.05);
  EXPECT_LT(cells.error, 1e-9);
  EXPECT_GT(cells.mean_sphericity, 0.8);
  EXPECT_LT(cells.mean_sphericity, 0.95);
  EXPECT_NEAR(cells.scale, 1, 1e-12);  // the box is as large as the cells together
  EXPECT_NEAR(packing.volume, std::accumulate(volumes.begin(), volumes.end(), 0.0), 1e-9 * packing.volume);
  for (const auto& [share, wanted, by_radii, reached] : cells.quantiles) {
    EXPECT_NEAR(reached, wanted, 0.1 * wanted) << share;
    EXPECT_NEAR(by_radii, wanted, (share < 0.05 ? 0.6 : 0.25) * wanted) << share;  // small ones lie in holes
  }
  EXPECT_NE(cells_in_words(cells).find("Kolmogorov distance"), std::string::npos);
}

TEST(Cells, OfEveryKindOfBox) {
  const std::string uniform =
      "cells = { volume = { distribution = \"uniform\", min = 0.001, max = 0.003, basis = \"number\" } }\n";
  for (const std::string container :
       {"kind = \"box\"\nsize = [1.0, 0.8, 0.5]\n", "kind = \"periodic\"\nsize = [1.0, 0.8, 0.5]\n",
        "kind = \"periodic\"\nsize = [1.0, 0.8, 0.5]\nwalls = [2]\n"}) {
    const Plan plan = build(scene_of("[container]\n" + container, uniform));
    EXPECT_EQ(plan.scene.target.count, 200) << "as many as fill the box";
    const Packing packing = run(plan);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
    const std::vector<double> volumes = sorted(cells_of(packing));
    for (std::size_t k = 0; k < volumes.size(); ++k)
      EXPECT_NEAR(volumes[k], 0.001 + 0.002 * (static_cast<double>(k) + 0.5) / 200, 1e-11) << container << k;
  }
}

TEST(Cells, OfOneVolumeAndOfClassesAreExact) {
  const Packing equal = run(build(scene_of(periodic, "count = 300\ncells = { volume = 2.0 }\n")));
  for (const double volume : cells_of(equal)) EXPECT_NEAR(volume, 2 * equal.cells->scale, 1e-9);
  EXPECT_EQ(equal.cells->distance, 0);
  EXPECT_EQ(std::ranges::max(equal.spheres.r), std::ranges::min(equal.spheres.r)) << "equal ones stay equal";
  const Packing two =
      run(build(scene_of(periodic,
                         "count = 300\ncells = { volume = { distribution = \"classes\", values = [1.0, 4.0], "
                         "shares = [2, 1], basis = \"number\" } }\n")));
  const std::vector<double> volumes = sorted(cells_of(two));
  EXPECT_NEAR(volumes[199], two.cells->scale, 1e-9);
  EXPECT_NEAR(volumes[200], 4 * two.cells->scale, 1e-8);
}

TEST(Cells, FewHaveTheirVolumeInABoxOfFreeSize) {
  for (const int count : {1, 2, 3, 5, 50}) {
    const Packing packing =
        run(build(scene_of(periodic, fmt::format("count = {}\ncells = {{ volume = 2.0 }}\n", count))));
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified) << count;
    for (const double volume : cells_of(packing)) EXPECT_NEAR(volume, 2, 1e-8) << count;
  }
}

TEST(Cells, VolumesMayHaveUnits) {
  const auto volume_of_cells = [](const std::string& volume) {
    const Scene scene = parse_scene(
        "unit = \"mm\"\n" + periodic + "[spheres]\ncount = 3\ncells = { volume = " + volume + " }\n",
        "s.toml");
    return std::get<Constant>(*scene.cells->volume).value;
  };
  EXPECT_DOUBLE_EQ(volume_of_cells("\"0.002 cm3\""), 2);
  EXPECT_DOUBLE_EQ(volume_of_cells("\"2 mm^3\""), 2);
  EXPECT_DOUBLE_EQ(volume_of_cells("\"2 mm³\""), 2);
  try {
    volume_of_cells("\"1 cm\"");
    ADD_FAILURE() << "a length is no volume";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("a positive volume"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("\"1 mm3\""), std::string::npos) << error.what();
  }
}

TEST(Cells, AreTheSameForAnyNumberOfThreadsAndAsRead) {
  const Scene scene = scene_of(periodic, "count = 200\n" + lognormal);
  const Packing one = run(build(scene), {.threads = 1}), two = run(build(scene), {.threads = 2});
  EXPECT_EQ(one.weights, two.weights);
  EXPECT_EQ(one.spheres, two.spheres);
  const testing::Folder folder;
  write_packing(one, folder / "out");
  const Packing read = read_packing(folder / "out");
  EXPECT_EQ(read.weights, one.weights);
  const Packing again = run(build(read.scene));  // from what stands in the result
  EXPECT_EQ(again.spheres, one.spheres);
  EXPECT_EQ(again.weights, one.weights);
  const Packing copy = packing_of_bytes(bytes_of(one));
  EXPECT_EQ(copy.weights, one.weights);
  EXPECT_EQ(copy.cells->steps, one.cells->steps);
}

TEST(Cells, WeightsOfAResultAreReadWholeOrRefused) {
  const testing::Folder folder;
  write_packing(run(build(scene_of(periodic, "count = 50\n" + lognormal))), folder / "out");
  std::filesystem::resize_file(folder / "out" / "weights.npy",
                               std::filesystem::file_size(folder / "out" / "weights.npy") - 8);
  EXPECT_THROW(read_packing(folder / "out"), Error);
  std::filesystem::remove(folder / "out" / "weights.npy");
  EXPECT_TRUE(read_packing(folder / "out").weights.empty());
}

TEST(Cells, ThatDoNotFillTheBoxAreScaledAndThatIsSaid) {
  const Plan plan = build(
      scene_of("[container]\nkind = \"periodic\"\nedge = 4.0\n", "count = 100\ncells = { volume = 1.28 }\n"));
  ASSERT_FALSE(plan.hints.empty());
  EXPECT_NE(plan.hints.back().find("100 cells of these sizes have 2 times the volume of the box: the volumes "
                                   "are all 0.5 times as large"),
            std::string::npos)
      << plan.hints.back();
}

TEST(Cells, StandInTheSceneAsTheyWereSaid) {
  for (const std::string& spheres :
       {"count = 10\n" + lognormal,
        std::string(
            "count = 10\ncells = { volume = { distribution = \"list\", values = [1.0, 2.0] }, rounds = "
            "0 }\n")}) {
    const Scene scene = scene_of(periodic, spheres);
    const std::string text = scene_as_toml(scene);
    EXPECT_NE(text.find("cells = { "), std::string::npos) << text;
    EXPECT_EQ(text.find("radius = "), std::string::npos) << text;
    EXPECT_EQ(scene_as_toml(parse_scene(text, "s.toml")), text);
  }
}

TEST(Cells, NothingElseIsAccepted) {
  const auto says = [](const std::string& container, const std::string& spheres, const std::string& part) {
    try {
      build(scene_of(container, spheres));
      ADD_FAILURE() << "accepted: " << spheres;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_scene) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      EXPECT_GT(error.location().line, 0) << error.what();
    }
  };
  says(periodic, "count = 10\ncells = {}\n", "needs exactly one of \"volume\", \"diameter\"");
  says(periodic, "count = 10\ncells = 3\n", "must be a table { volume = … }, not 3");
  says(periodic, "count = 10\ncells = { volume = 1, diameter = 1 }\n", "exclude each other");
  says(periodic, "count = 10\ncells = { volume = 1, size = 1 }\n", "unknown key \"size\"");
  says(periodic, "count = 10\ncells = { volume = -1 }\n", "must be a positive volume");
  says(periodic, "count = 10\nradius = 1\ncells = { volume = 1 }\n", "exclude each other");
  says(periodic, "cells = { volume = 1 }\n", "needs a \"count\"");
  says(periodic, "count = 10\nscale = 2\ncells = { volume = 1 }\n", "leave \"scale\" out");
  says(periodic, "count = 10\ndraw = \"random\"\ncells = { volume = 1 }\n", "leave \"draw\" out");
  says(periodic,
       "count = 10\ncells = { volume = { distribution = \"lognormal\", median = 1, sigma = 0.5, basis = "
       "\"volume\" } }\n",
       "give the \"diameter\" of balls of the same volume");
  says(periodic,
       "count = 10\ncells = { volume = { distribution = \"rosin_rammler\", d63 = 1, n = 4, min = 0.5 } }\n",
       "give the \"diameter\"");
  says("[container]\nkind = \"periodic\"\ndimension = 2\n", "count = 10\ncells = { volume = 1 }\n",
       "three dimensions, and the scene has 2");
  says("[container]\nkind = \"cylinder\"\nradius = 1\nheight = 1\n", "count = 10\ncells = { volume = 1 }\n",
       "need a box with plain walls");
  says("[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n", "cells = { volume = 100 }\n",
       "check the units");
}

TEST(Cells, AreCancelledWhole) {
  RunOptions options;
  std::size_t polls = 0;
  options.monitor.cancelled = [&] { return ++polls > 40; };
  const Packing packing = run(build(scene_of(periodic, "count = 2000\n" + lognormal)), options);
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_TRUE(packing.weights.empty());
  EXPECT_TRUE(packing.scene.cells);
}

// Their volumes are from 1e-5 to 4e4: rounding ended it, and the run with nothing to show.
TEST(Cells, ThatRoundingKeepsFromTheirVolumesFallShort) {
  const Packing packing = run(build(scene_of(
      periodic,
      "count = 30\ncells = { volume = { distribution = \"lognormal\", median = 1, sigma = 5 } }\n")));
  EXPECT_EQ(packing.outcome, Outcome::hit_limit) << packing.reason;
  EXPECT_NE(packing.reason.find("ask for a narrower distribution"), std::string::npos) << packing.reason;
  EXPECT_EQ(packing.weights.size(), 30u);
  ASSERT_TRUE(packing.cells);
  EXPECT_GT(packing.cells->error, 1e-8);
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  const testing::Folder folder;
  write_packing(packing, folder / "out");
  EXPECT_EQ(read_packing(folder / "out").weights, packing.weights);
}

TEST(Cells, TheExampleIsPacked) {
  Scene scene = read_scene(BERNAL_DATA "/cells/grains.toml");
  EXPECT_EQ(scene.target.count, 5000);
  scene.target.count = 250;
  const Packing packing = run(build(scene));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_LT(packing.cells->distance, 0.0021);
}

}  // namespace cells_scene_test
}  // namespace bernal
