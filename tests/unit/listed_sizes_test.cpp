// Sizes one by one: lists, each size exactly once, in the scene, in files and in results.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/plan/plan.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/packing_bytes.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "files/npy_file.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace listed_sizes_test {

Scene scene_of(const std::string& spheres) { return parse_scene(testing::with_spheres(spheres), "s.toml"); }

std::vector<double> sorted(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

/// Diameters with all their bits, of which some occur more than once.
std::vector<double> measured(std::size_t n) {
  std::mt19937_64 random(7);
  std::vector<double> values;
  while (values.size() < n) values.push_back(0.1 + std::uniform_real_distribution<>()(random));
  for (std::size_t k = 0; k + 7 < n; k += 7) values[k + 3] = values[k];
  return values;
}

std::vector<double> doubled(std::vector<double> radii) {
  for (double& r : radii) r *= 2;
  return radii;
}

TEST(List, IsPackedEachExactlyOnceToTheBit) {
  const std::vector<double> values = measured(1000);
  const std::string list =
      fmt::format("{{ distribution = \"list\", values = [{}] }}", fmt::join(values, ", "));
  for (const std::string container : {"kind = \"periodic\"", "kind = \"cylinder\"\nradius = 4\nheight = 12",
                                      "kind = \"periodic\"\nsize = [9, 9, 9]"})
    for (const int seed : {1, 2}) {
      Scene scene =
          parse_scene(fmt::format("[container]\n{}\n[spheres]\ndiameter = {}\n", container, list), "s.toml");
      EXPECT_EQ(scene.target.count, 1000);
      scene.seed = static_cast<std::uint64_t>(seed);
      const Packing packing = run(build(scene));
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
      EXPECT_EQ(sorted(doubled(packing.spheres.r)), sorted(values)) << container;
      EXPECT_NE(doubled(packing.spheres.r), values);  // the seed says in which order
    }
}

TEST(List, OfManyIsDealtOutWhole) {
  for (const std::size_t n : {1U, 2U, 3U, 99U, 100'000U}) {
    const std::vector<double> values = measured(n);
    ListedSizes list{.values = values};
    Scene scene = scene_of("radius = 1");
    scene.sizes = list;
    const auto radii = radii_of(scene);
    RadiusSequence sequence(*radii, 3, Draw::quantiles);
    std::vector<double> dealt(n);
    for (double& r : dealt) r = sequence.next();
    EXPECT_EQ(sorted(dealt), sorted(values)) << n;
  }
  // One size often, and many once.
  std::vector<double> values(5000, 1.0);
  for (int k = 0; k < 3000; ++k) values.push_back(2 + 1e-3 * k);
  Scene scene = scene_of("radius = 1");
  scene.sizes = ListedSizes{.values = values};
  const auto radii = radii_of(scene);
  RadiusSequence sequence(*radii, 3, Draw::quantiles);
  std::vector<double> dealt(values.size());
  for (double& r : dealt) r = sequence.next();
  EXPECT_EQ(sorted(dealt), sorted(values));
}

TEST(List, StandsInAFileAsTextOrAsAnArray) {
  const testing::Folder folder;
  folder.write("list.csv", "diameter (mm)\n1.5\n  2.25\n\n1e0  # the smallest\n");
  std::string bytes = npy_header(3, 0);
  for (const double d : {1.5, 2.25, 1.0}) bytes.append(reinterpret_cast<const char*>(&d), sizeof d);
  folder.write("list.npy", bytes);
  for (const std::string name : {"list.csv", "list.npy"}) {
    const Scene scene = parse_scene(
        "unit = \"mm\"\n" +
            testing::with_spheres("diameter = { distribution = \"list\", file = \"" + name + "\" }"),
        folder / "s.toml");
    EXPECT_EQ(std::get<ListedSizes>(scene.sizes).values, (std::vector<double>{1.5, 2.25, 1})) << name;
    EXPECT_EQ(scene.target.count, 3);
  }
  folder.write("two.csv", "1.5, 2\n");
  folder.write("none.csv", "diameters\n");
  folder.write("comma.csv", "1,5\n");
  for (const auto& [name, why] :
       {std::pair("two.csv", "one of the values, a number"), std::pair("none.csv", "no line has a number"),
        std::pair("comma.csv", "write 1.5 in place of the decimal comma")}) {
    try {
      parse_scene(
          testing::with_spheres(fmt::format("diameter = {{ distribution = \"list\", file = \"{}\" }}", name)),
          folder / "s.toml");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }
}

// What a run writes is read again: a few sizes in the scene, many in a file beside it.
TEST(List, OfAResultIsReadAgain) {
  for (const std::size_t n : {40U, 1500U}) {
    const std::vector<double> values = measured(n);
    Scene scene =
        parse_scene("[container]\nkind = \"periodic\"\n[spheres]\ndiameter = 1\ncount = 2\n", "s.toml");
    scene.sizes = ListedSizes{.values = values};
    scene.target.count.reset();
    const Packing packing = run(build(scene));
    const testing::Folder folder;
    write_packing(packing, folder / "out");
    std::size_t beside = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
      beside += entry.path().filename().string().starts_with("sizes-");
    EXPECT_EQ(beside, n > 1000 ? 1U : 0U);
    const Packing again = read_packing(folder / "out");
    EXPECT_EQ(std::get<ListedSizes>(again.scene.sizes).values, values);
    EXPECT_EQ(sorted(doubled(again.spheres.r)), sorted(values));
    EXPECT_EQ(run(build(again.scene)).spheres.r, packing.spheres.r);
    check_writable(folder / "out", again.scene, {});  // it may be written there again
    const Packing of_bytes = packing_of_bytes(bytes_of(packing));
    EXPECT_EQ(std::get<ListedSizes>(of_bytes.scene.sizes).values, values);
    write_scene(scene, folder / "alone" / "scene.toml");
    const std::filesystem::path alone = folder / "alone" / "scene.toml";
    EXPECT_EQ(std::get<ListedSizes>(read_scene(alone).sizes).values, values);
    std::ofstream(folder / "out" / "scene.toml", std::ios::app) << "# mine\n";
    testing::error_of([&] { check_writable(folder / "out", again.scene, {}); });
  }
}

TEST(List, MayBeDrawnFromInsteadAndInAMixture) {
  const Scene scene = scene_of(
      "count = 300\ndiameter = { distribution = \"list\", values = [1, 2, 2, 3], draw = \"resample\" }");
  const auto radii = radii_of(scene);
  EXPECT_NEAR(radii->cumulative(1), 0.75, 1e-15);
  EXPECT_EQ(radii->atoms(), (std::vector<double>{0.5, 1, 1.5}));
  EXPECT_EQ(run(build(scene)).spheres.size(), 300U);
  EXPECT_NO_THROW(
      radii_of(scene_of("radius = { distribution = \"mixture\", shares = [1, 1], of = [1, { distribution = "
                        "\"list\", values = [1, 2], draw = \"resample\" }] }")));
}

TEST(List, ComesAfterTheSpheresOfAStart) {
  const testing::Folder folder;
  folder.write("there.csv", "x,y,z,r\n2,2,2,1\n6,6,6,1\n");
  const auto plan_of = [&](const std::string& count) {
    return build(
        parse_scene("[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\nstart = \"there.csv\"\n" +
                        count + "diameter = { distribution = \"list\", values = [1.25, 1.5, 1] }\n",
                    folder / "s.toml"));
  };
  EXPECT_EQ(plan_of("").scene.target.count, 5);
  EXPECT_EQ(sorted(doubled(run(plan_of("count = 5\n")).spheres.r)),
            (std::vector<double>{1, 1.25, 1.5, 2, 2}));
  EXPECT_THROW(plan_of("count = 3\n"), Error);
}

}  // namespace listed_sizes_test
}  // namespace bernal
