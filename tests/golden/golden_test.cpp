#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/version.hpp"
#include "files/sha256.hpp"

// What a scene packs to stays what it is, bit for bit, and takes no more or less work than it took, in calls
// of effects, which are the same on every machine: hashes.csv pins both for the scenes of this folder and a
// few of data/scenes. tests/golden/table writes it, and says when it may.
namespace bernal {
namespace golden_test {

const std::filesystem::path folder = BERNAL_SOURCE "/tests/golden";

/// A line of hashes.csv below its header.
struct Row {
  std::string pinned, work;  ///< as they are written
  std::size_t n = 0;
  double packing_fraction = 0;
  std::string outcome, hash;
  int since = -1;  ///< the packings number
};

/// By the name of the scene.
std::multimap<std::string, Row> rows_of_table() {
  std::multimap<std::string, Row> rows;
  std::ifstream table(folder / "hashes.csv");
  std::string line;
  std::getline(table, line);
  std::getline(table, line);
  while (std::getline(table, line)) {
    Row row;
    const std::size_t first = line.find(','), last = line.rfind(',');
    row.pinned = line.substr(0, last);
    row.work = line.substr(last + 1);
    std::string fields = row.pinned.substr(std::min(first, row.pinned.size()));
    std::ranges::replace(fields, ',', ' ');
    std::istringstream(fields) >> row.n >> row.packing_fraction >> row.outcome >> row.hash >> row.since;
    rows.emplace(line.substr(0, first), row);
  }
  return rows;
}

/// Of every scene in this folder and of every row: neither may be without the other.
std::set<std::string> names() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  for (const auto& [name, row] : rows_of_table()) names.insert(name);
  return names;
}

/// Of "relaxation 4360; neighbour lists 710": calls by effect.
std::map<std::string, double> work_of(const std::string& pinned) {
  std::map<std::string, double> calls;
  std::istringstream all(pinned);
  std::string one;
  while (std::getline(all >> std::ws, one, ';')) {
    const std::size_t blank = one.rfind(' ');
    calls[one.substr(0, blank)] = std::stod(one.substr(blank + 1));
  }
  return calls;
}

/// Work may change by so much until the table is made anew.
constexpr double most_change = 0.2;

void expect_work(const std::vector<Effect>& effects, const std::string& pinned) {
  std::map<std::string, double> left = work_of(pinned);
  for (const Effect& effect : effects) {
    const auto calls = static_cast<double>(effect.calls);
    EXPECT_TRUE(left.contains(effect.name)) << effect.name << " is new, with " << calls << " calls";
    const double before = left[effect.name];
    EXPECT_LE(std::abs(calls - before), most_change * before) << effect.name << ": the table says " << before;
    left.erase(effect.name);
  }
  for (const auto& [name, calls] : left) ADD_FAILURE() << name << " had " << calls << " calls and has none";
}

TEST(GoldenWork, IsToldByMoreThanAFifth) {
  const std::string pinned = "relaxation 100; neighbour lists 10";
  expect_work({{"neighbour lists", 12, 0.5}, {"relaxation", 80, 0}}, pinned);
  EXPECT_EQ(work_of(pinned), (std::map<std::string, double>{{"relaxation", 100}, {"neighbour lists", 10}}));
  EXPECT_NONFATAL_FAILURE(expect_work({{"neighbour lists", 13, 0}, {"relaxation", 100, 0}}, pinned),
                          "says 10");
  EXPECT_NONFATAL_FAILURE(expect_work({{"neighbour lists", 10, 0}, {"relaxation", 79, 0}}, pinned),
                          "says 100");
  EXPECT_NONFATAL_FAILURE(expect_work({{"relaxation", 100, 0}}, pinned), "has none");
}

/// Who gives a row another hash, or the number another value, by hand, or merges two branches that did,
/// breaks the seal. tests/golden/table makes it anew, and then the number is another one.
TEST(GoldenTable, IsSealedTogetherWithThePackingsNumber) {
  std::ifstream table(folder / "hashes.csv");
  std::string seal, line, text = std::to_string(packings_number()) + "\n";
  std::getline(table, seal);
  std::getline(table, line);
  while (std::getline(table, line)) text += line.substr(0, line.rfind(',')) + "\n";
  EXPECT_EQ(seal, "# seal " + sha256_of_bytes(text).substr(0, 16))
      << "rows or src/core/version.cpp were changed by hand: run tests/golden/table";
  for (const auto& [name, row] : rows_of_table()) EXPECT_LE(row.since, packings_number()) << name;
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
  const Row row = rows.find(GetParam())->second;
  ASSERT_GE(row.since, 0) << row.pinned;

  const Packing packing = run(build(read_scene(file)));
  EXPECT_EQ(packing.spheres.size(), row.n) << packing.reason;
  // The hash is of spheres alone: this is what pins the box.
  EXPECT_EQ(packing.packing_fraction(), row.packing_fraction);
  EXPECT_EQ(name_of(packing.outcome), row.outcome) << packing.reason;
  EXPECT_EQ(hash_of(packing.spheres), row.hash);
  expect_work(packing.effects, row.work);
}

}  // namespace golden_test
}  // namespace bernal
