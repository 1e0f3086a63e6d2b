#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/folder.hpp"

// tests/golden/table lets the packings number grow where a row that it has changes, and only there: a copy of
// it, in a small source of its own, with a bernal that packs what stands in the scene.
namespace bernal {
namespace table_test {

namespace fs = std::filesystem;

class Table : public ::testing::Test {
 protected:
  Table() {
    for (const char* name : {"tests/golden", "src/core", "data/scenes"})
      fs::create_directories(folder_ / name);
    fs::copy(BERNAL_SOURCE "/tests/golden/table", folder_ / "tests/golden/table");
    folder_.write("src/core/version.cpp", "constexpr int packings = 7;\n");
    for (const char* name :
         {"box_two_classes", "fly_five_dimensions", "fly_patent", "fly_propellant", "relax_two_sizes"})
      folder_.write(std::string("data/scenes/") + name + ".toml", "11");
    folder_.write("tests/golden/one.toml", "aa");
    folder_.write("tests/golden/two.toml", "bb");
    folder_.write("tests/golden/hashes.csv", "");
    folder_.write("bernal", R"sh(#!/bin/sh
mkdir -p "$4"
cat >"$4/report.json" <<END
{
  "outcome": "converged",
  "n": 5,
  "phi": 0.5,
  "hash": "$(cat "$2")",
  "effects": [
    {
      "name": "relaxation",
      "calls": 3,
      "seconds": 0
    }
  ]
}
END
)sh");
    fs::permissions(folder_ / "bernal", fs::perms::owner_exec, fs::perm_options::add);
    EXPECT_EQ(make(""), 8) << "a table that is not there yet has no seal";
  }

  bool runs(const std::string& options) {
    const std::string call = "'" + (folder_ / "tests/golden/table").string() + "' " + options + " '" +
                             (folder_ / "bernal").string() + "' >'" + (folder_ / "said").string() + "' 2>&1";
    return std::system(call.c_str()) == 0;
  }
  /// Returns the packings number afterwards.
  int make(const std::string& options) {
    EXPECT_TRUE(runs(options)) << testing::text_of(folder_ / "said");
    const std::string source = testing::text_of(folder_ / "src/core/version.cpp");
    return std::stoi(source.substr(source.find('=') + 1));
  }
  std::string table() { return testing::text_of(folder_ / "tests/golden/hashes.csv"); }
  bool has(const std::string& row) { return table().find("\n" + row + "\n") != std::string::npos; }

  testing::Folder folder_;
};

TEST_F(Table, NumberGrowsWhereARowChangesAndTheRowSaysSo) {
  const std::string before = table();
  EXPECT_EQ(make(""), 8);
  EXPECT_EQ(table(), before);
  folder_.write("tests/golden/two.toml", "cc");
  EXPECT_EQ(make(""), 9);
  EXPECT_TRUE(has("one,5,0.5,converged,aa,8,relaxation 3")) << table();
  EXPECT_TRUE(has("two,5,0.5,converged,cc,9,relaxation 3")) << table();
}

TEST_F(Table, NumberStaysWhereRowsComeAndGo) {
  folder_.write("tests/golden/three.toml", "dd");
  EXPECT_EQ(make(""), 8);
  EXPECT_TRUE(has("three,5,0.5,converged,dd,8,relaxation 3")) << table();
  fs::remove(folder_ / "tests/golden/one.toml");
  EXPECT_EQ(make(""), 8);
}

TEST_F(Table, NumberIsNotLoweredAndWhatIsNotPackedIsNoRow) {
  const std::string before = table();
  folder_.write("src/core/version.cpp", "constexpr int packings = 7;\n");
  EXPECT_FALSE(runs(""));
  folder_.write("src/core/version.cpp", "constexpr int packings = 8;\n");
  folder_.write("bernal", "#!/bin/sh\nexit 3\n");
  EXPECT_FALSE(runs(""));
  EXPECT_EQ(table(), before);
}

TEST_F(Table, NumberGrowsAfterWhatWasDoneByHand) {
  std::string text = table();
  text.replace(text.find(",aa,"), 4, ",ab,");
  folder_.write("tests/golden/hashes.csv", text);
  folder_.write("tests/golden/one.toml", "ab");  // so that no row differs
  EXPECT_EQ(make(""), 9);
  EXPECT_EQ(make("--grow"), 10);
  EXPECT_EQ(make(""), 10);
}

}  // namespace table_test
}  // namespace bernal
