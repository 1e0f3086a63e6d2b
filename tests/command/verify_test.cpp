#include <fmt/format.h>

#include "check.hpp"

namespace bernal::testing {
namespace {

constexpr const char* box_scene = R"(unit = "mm"
[container]
kind = "box"
size = [4, 4, 4]
[spheres]
radius = 1
)";

/// Two spheres that touch each other and the walls, exactly.
constexpr const char* touching = "# unit: mm\nx,y,z,r\n1,1,1,1\n3,1,1,1\n";

class Verify : public ::testing::Test {
 protected:
  Folder folder;
  std::string scene = folder.write("scene.toml", box_scene).string();

  Ended with(const std::string& csv) {
    folder.write("spheres.csv", csv);
    return bernal({"verify", folder.path().string()});
  }
};

TEST_F(Verify, TouchingIsAllowed) {
  const Ended ended = with(touching);
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_NE(ended.out.find("certified  yes"), std::string::npos) << ended.out;
}

TEST_F(Verify, FindsTheSmallestTampering) {
  // One unit in the last place nearer to the other sphere, or to the wall.
  EXPECT_EQ(with("# unit: mm\nx,y,z,r\n1,1,1,1\n2.9999999999999996,1,1,1\n").status, 1);
  EXPECT_EQ(with("# unit: mm\nx,y,z,r\n1,1,1,1\n3.0000000000000004,1,1,1\n").status, 1);
  EXPECT_EQ(with("# unit: mm\nx,y,z,r\n1,1,0.9999999999999999,1\n3,1,1,1\n").status, 1);
  EXPECT_EQ(with("# unit: mm\nx,y,z,r\n9,9,9,1\n").status, 1);
  const Ended overlapping = with("# unit: mm\nx,y,z,r\n1,1,1,1\n2,1,1,1\n");
  EXPECT_EQ(overlapping.status, 1);
  EXPECT_NE(overlapping.out.find("certified  NO"), std::string::npos) << overlapping.out;
  EXPECT_NE(overlapping.out.find("1 overlapping; worst: 0 and 1, overlap ratio 0.5"), std::string::npos)
      << overlapping.out;
}

TEST_F(Verify, AllowsTheOverlapThatTheSceneAllows) {
  folder.write("scene.toml", std::string(box_scene) + "[accuracy]\noverlap = 0.1\n");
  EXPECT_EQ(with("# unit: mm\nx,y,z,r\n1,1,1,1\n2.9,1,1,1\n").status, 0);
  EXPECT_EQ(with("# unit: mm\nx,y,z,r\n1,1,1,1\n2.7,1,1,1\n").status, 1);
}

TEST_F(Verify, JsonIsOneObjectAndNothingElse) {
  with(touching);
  const Ended json = bernal({"verify", folder.path().string(), "--json", "--threads", "1"});
  EXPECT_EQ(json.status, 0);
  EXPECT_EQ(json.err, "");
  const auto certificate = nlohmann::json::parse(json.out);
  EXPECT_EQ(certificate["certified"], true);
  EXPECT_EQ(certificate["spheres"], 2);
  EXPECT_EQ(certificate["pairs_tested"], 1);
  EXPECT_EQ(certificate["max_overlap"], 0);
}

TEST_F(Verify, OneFileNeedsAScene) {
  const std::string file = folder.write("other.csv", touching).string();
  EXPECT_EQ(bernal({"verify", file, "--scene", scene}).status, 0);
  expect_refused_in_one_line(bernal({"verify", file}), {"other.csv", "--scene"});
}

TEST_F(Verify, BadFilesAreNotAVerdict) {
  expect_refused_in_one_line(with("# unit: m\nx,y,z,r\n1,1,1,1\n"), {"spheres.csv", "in m,", "in mm"});
  expect_refused_in_one_line(with(""), {"spheres.csv"});
  expect_refused_in_one_line(with("x,y,z,r\n1,1,1\n"), {"spheres.csv:2"});
  expect_refused_in_one_line(with("x,y,z,r\n1,1,1,nan\n"), {"spheres.csv:2"});
  expect_refused_in_one_line(with("x,y,z,r\n1,1,1,-1\n"), {"spheres.csv:2"});
  std::filesystem::remove(folder / "spheres.csv");
  expect_refused_in_one_line(bernal({"verify", folder.path().string()}), {"spheres.csv"});
  expect_refused_in_one_line(bernal({"verify", (folder / "none").string()}), {"none"});
  folder.write("scene.toml", "");
  expect_refused_in_one_line(with(touching), {"scene.toml"});
}

}  // namespace
}  // namespace bernal::testing
