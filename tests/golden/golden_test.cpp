#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"

// What a scene packs to stays what it is, bit for bit: hashes.csv pins it for the scenes of this folder and a
// few of data/scenes. tests/golden/table writes it, and says when it may.
namespace bernal {
namespace golden_test {

const std::filesystem::path folder = BERNAL_SOURCE "/tests/golden";

/// The lines of hashes.csv below its header: the name of a scene, and what it is pinned to.
std::multimap<std::string, std::string> rows_of_table() {
  std::multimap<std::string, std::string> rows;
  std::ifstream table(folder / "hashes.csv");
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string name, pinned;
    std::getline(fields, name, ',');
    std::getline(fields, pinned);
    rows.emplace(name, pinned);
  }
  return rows;
}

/// Of every scene in this folder and of every row: neither may be without the other.
std::set<std::string> names() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  for (const auto& [name, pinned] : rows_of_table()) names.insert(name);
  return names;
}

class GoldenScene : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(, GoldenScene, ::testing::ValuesIn(names()), [](const auto& scene) {
  return std::filesystem::path(scene.param).filename().string();
});

TEST_P(GoldenScene, PacksToWhatIsPinned) {
  const std::filesystem::path file = folder / (GetParam() + ".toml");
  ASSERT_TRUE(std::filesystem::exists(file)) << "hashes.csv pins it, but there is no such scene";
  const auto rows = rows_of_table();
  ASSERT_EQ(rows.count(GetParam()), 1u) << "rows in hashes.csv; write one with tests/golden/table";
  std::string pinned = rows.find(GetParam())->second;
  std::ranges::replace(pinned, ',', ' ');
  std::istringstream fields(pinned);
  std::size_t n = 0;
  double phi = 0;
  std::string outcome, hash;
  ASSERT_TRUE(fields >> n >> phi >> outcome >> hash) << pinned;

  const Packing packing = run(build(read_scene(file)));
  EXPECT_EQ(packing.spheres.size(), n) << packing.reason;
  EXPECT_EQ(packing.packing_fraction(), phi);  // the hash is of spheres alone: this is what pins the box
  EXPECT_EQ(name_of(packing.outcome), outcome) << packing.reason;
  EXPECT_EQ(hash_of(packing.spheres), hash);
}

}  // namespace golden_test
}  // namespace bernal
