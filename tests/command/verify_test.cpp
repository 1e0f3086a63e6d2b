#include <fmt/format.h>

#include "check.hpp"

namespace bernal::testing {
namespace verify_test {

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

// A quarter apart and an eighth from the walls, exactly.
TEST_F(Verify, ProvesTheGapsThatTheSceneAsksFor) {
  folder.write("scene.toml", std::string(box_scene) + "gap = 0.25\nwall_gap = 0.125\n");
  const std::string kept = "# unit: mm\nx,y,z,r\n1,1,1,0.875\n3,1,1,0.875\n";
  const Ended ended = with(kept);
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_NE(ended.out.find("0.25 between spheres, least 0.25; 0.125 from walls, least 0.125"),
            std::string::npos)
      << ended.out;
  const Ended nearer = with("# unit: mm\nx,y,z,r\n1,1,1,0.875\n2.9999999999999996,1,1,0.875\n");
  EXPECT_EQ(nearer.status, 1);
  EXPECT_NE(nearer.out.find("1 pair nearer than the gap of 0.25 (worst 0 and 1"), std::string::npos)
      << nearer.out;
  const Ended at_wall = with("# unit: mm\nx,y,z,r\n1,1,0.9999999999999999,0.875\n3,1,1,0.875\n");
  EXPECT_EQ(at_wall.status, 1);
  EXPECT_NE(at_wall.out.find("1 sphere nearer to the wall than its gap of 0.125 (worst 0"), std::string::npos)
      << at_wall.out;

  const std::string file = folder.write("theirs.csv", kept).string();
  EXPECT_EQ(bernal({"verify", file, "--scene", scene}).status, 0);
  const auto json = nlohmann::json::parse(bernal({"verify", file, "--scene", scene, "--json"}).out);
  EXPECT_EQ(json["gap"], 0.25);
  EXPECT_EQ(json["wall_gap"], 0.125);
  EXPECT_EQ(json["least_distance"], 0.25);
  EXPECT_EQ(json["least_wall_distance"], 0.125);
  folder.write("scene.toml", std::string(box_scene) + "gap = 0.2500001\nwall_gap = 0.125\n");
  EXPECT_EQ(bernal({"verify", file, "--scene", scene}).status, 1);
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

TEST_F(Verify, OneFileMayBeOfAnotherProgram) {
  const std::string file = folder.write("theirs.csv", "id;Diameter;z;y;x\n7;2;1;1;1\n8;2;1;1;3\n").string();
  EXPECT_EQ(bernal({"verify", file, "--scene", scene}).status, 0);
  folder.write("theirs.csv", "id;diameter;z;y;x\n7;2;1;1;1\n8;2;1;1;2.9\n");
  EXPECT_EQ(bernal({"verify", file, "--scene", scene}).status, 1);
  folder.write("theirs.csv", "id;z;y;x\n7;1;1;1\n");
  expect_refused_in_one_line(bernal({"verify", file, "--scene", scene}), {"theirs.csv:1", "diameter"});
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

// ---- Layers

TEST(VerifyLayers, TheirTableIsHeldAgainstTheSceneAndTheSpheres) {
  const Folder folder;
  const std::string scene =
      folder
          .write(
              "coated.toml",
              "seed = 5\n" + std::string(small_scene) +
                  R"(layers = [{ name = "core", material = "glass" }, { name = "coat", thickness = { distribution = "normal", mean = 0.05, sd = 0.01, min = 0.01, max = 0.09 } }])"
                  "\n")
          .string();
  const std::string out = (folder / "out").string(), table = out + "/layers.csv";
  ASSERT_EQ(bernal({"pack", scene, "-o", out, "--quiet"}).status, 0);
  const Ended kept = bernal({"verify", out});
  EXPECT_EQ(kept.status, 0) << kept.out << kept.err;
  EXPECT_NE(kept.out.find("layers.csv has the 600 layers"), std::string::npos) << kept.out;

  const auto expect_fault = [&](const std::string& words) {
    const Ended ended = bernal({"verify", out});
    EXPECT_EQ(ended.status, 1) << words << ended.out << ended.err;
    EXPECT_NE(ended.out.find("certified  NO"), std::string::npos) << ended.out;
    EXPECT_NE(ended.out.find("Not certified: " + out + "/layers.csv" + words), std::string::npos)
        << words << ended.out;
    EXPECT_EQ(nlohmann::json::parse(bernal({"verify", out, "--json"}).out)["certified"], false);
  };
  const auto with_table = [&](const std::string& text) { folder.write("out/layers.csv", text); };
  const std::string written = text_of(table);
  std::string changed = written;
  changed.replace(changed.find("glass"), 5, "steel");
  with_table(changed);
  expect_fault(":3: says otherwise");
  changed = written;
  const std::size_t digit = changed.find("\n0,coat,coat,0.4") + 16;
  changed[digit] = changed[digit] == '5' ? '6' : '5';
  with_table(changed);
  expect_fault(":4: says otherwise than the scene and the spheres, by which \"coat\" of sphere 0");
  with_table(written.substr(0, written.rfind("\n299,core") + 1));
  expect_fault(":600: ends here, where \"core\" of sphere 299");
  with_table(written + "300,core,glass,0,0.4\n");
  expect_fault(":603: has more layers");
  with_table(written.substr(0, written.size() / 2));
  expect_fault(":");
  with_table("");
  expect_fault(": ");
  with_table(written);
  EXPECT_EQ(bernal({"verify", out}).status, 0);

  // Of another seed the same spheres have other layers; those of another scene have none.
  std::string other = text_of(out + "/scene.toml");
  ASSERT_NE(other.find("seed = 5\n"), std::string::npos) << other;
  other.replace(other.find("seed = 5\n"), 9, "seed = 6\n");
  folder.write("out/scene.toml", other);
  expect_fault(":3: says otherwise");
  folder.write("out/scene.toml", small_scene);
  expect_fault(": the scene names no layers");
  EXPECT_EQ(bernal({"verify", out + "/spheres.csv", "--scene", scene}).status, 0);
}

// ---- Periodic boxes

/// Packed once a dimension: 60 spheres in a box that follows from them.
std::string packed(int dimension, const Folder& folder) {
  const std::string scene = folder
                                .write("periodic.toml", fmt::format(R"(unit = "mm"
[container]
kind = "periodic"
dimension = {}
[spheres]
count = 60
radius = {{ distribution = "uniform", min = 0.5, max = 1.0 }}
[[stage]]
do = "relax"
alpha = 1
)",
                                                                    dimension))
                                .string();
  const std::string out = (folder / "out").string();
  const Ended ended = bernal({"pack", scene, "-o", out, "--quiet"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  return out;
}

class VerifyPeriodic : public ::testing::TestWithParam<int> {
 protected:
  Folder folder;
  std::string out = packed(GetParam(), folder);
  std::string csv = out + "/spheres.csv", scene = out + "/scene.toml";
};

INSTANTIATE_TEST_SUITE_P(Dimensions, VerifyPeriodic, ::testing::Values(2, 3, 4),
                         [](const auto& test) { return fmt::format("D{}", test.param); });

TEST_P(VerifyPeriodic, CertifiesWhatWasPacked) {
  const Ended of_folder = bernal({"verify", out});
  EXPECT_EQ(of_folder.status, 0) << of_folder.out << of_folder.err;
  EXPECT_NE(
      of_folder.out.find(GetParam() == 2 ? "60 discs in a periodic box" : "60 spheres in a periodic box"),
      std::string::npos)
      << of_folder.out;
  EXPECT_EQ(of_folder.out.find("walls"), std::string::npos) << of_folder.out;
  EXPECT_EQ(bernal({"verify", csv, "--scene", scene}).status, 0);

  const auto json = nlohmann::json::parse(bernal({"verify", out, "--json"}).out);
  const auto report = report_of(out);
  EXPECT_EQ(json["certified"], true);
  EXPECT_EQ(report["certified"], true);
  EXPECT_TRUE(json["worst_wall"].is_null());
  EXPECT_EQ(report["dimension"], GetParam());
  EXPECT_EQ(report["box"]["edges"].size(), static_cast<std::size_t>(GetParam()));
  // The report's certificate is the same object, but for the time that it took.
  for (const auto& [key, value] : json.items()) {
    if (key != "seconds") {
      EXPECT_EQ(report["certificate"][key], value) << key;
    }
  }
}

TEST_P(VerifyPeriodic, FindsASphereThatWasPutAcrossTheFace) {
  // The last line becomes an image of the first sphere on the other side of the box.
  const auto edges = report_of(out)["box"]["edges"].get<std::vector<double>>();
  std::string text = text_of(csv);
  std::vector<std::string> lines;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    lines.push_back(text.substr(at, end - at));
  const std::size_t comma = lines[2].find(',');
  lines.back() = fmt::format("{}{}", std::stod(lines[2]) - edges[0], lines[2].substr(comma));
  text.clear();
  for (const std::string& line : lines) text += line + "\n";
  const std::string tampered = folder.write("tampered.csv", text).string();
  const Ended ended = bernal({"verify", tampered, "--scene", scene});
  EXPECT_EQ(ended.status, 1) << ended.out << ended.err;
  EXPECT_NE(ended.out.find("worst: 0 and 59, overlap ratio 1"), std::string::npos) << ended.out;
}

TEST_P(VerifyPeriodic, WantsTheDimensionAndTheBoxOfTheScene) {
  const char* other = GetParam() == 3 ? "x0,x1,r\n1,1,1\n" : "x,y,z,r\n1,1,1,1\n";
  const std::string file = folder.write("other.csv", other).string();
  expect_refused_in_one_line(bernal({"verify", file, "--scene", scene}),
                             {"other.csv", "dimensions", fmt::format("the scene has {};", GetParam())});
  // The scene that was packed does not say how large the box became; that which was written does.
  expect_refused_in_one_line(bernal({"verify", csv, "--scene", (folder / "periodic.toml").string()}),
                             {"periodic.toml:2", "\"size\""});
}

TEST_F(Verify, AContainerHasThreeDimensions) {
  expect_refused_in_one_line(with("x0,x1,r\n1,1,1\n"), {"spheres.csv", "2 dimensions", "the scene has 3"});
}

TEST_F(Verify, ASphereMayTouchItsOwnImageAndNoMore) {
  folder.write("scene.toml", "[container]\nkind = \"periodic\"\nsize = [2, 5, 7]\n[spheres]\nradius = 1\n");
  EXPECT_EQ(with("x,y,z,r\n1,1,1,1\n").status, 0);
  const Ended ended = with("x,y,z,r\n1,1,1,1.25\n");
  EXPECT_EQ(ended.status, 1);
  EXPECT_NE(ended.out.find("1 overlapping; worst: 0 and its own image, overlap ratio 0.2"), std::string::npos)
      << ended.out;
}

// The answer does not depend on how much of it is read.
TEST_F(Verify, AReaderThatLeavesChangesNoAnswer) {
  std::string csv = "# unit: mm\nx,y,z,r\n";
  for (int i = 0; i < 400; ++i) csv += fmt::format("2,2,{},0.5\n", 2 + 1e-3 * i);
  folder.write("spheres.csv", csv);
  for (const char* reader : {"true", "head -1"}) {
    const std::string call =
        "set -o pipefail; '" BERNAL_COMMAND "' verify '" + folder.path().string() + "' --list | ";
    EXPECT_EQ(Process({"bash", "-c", call + reader}).wait().status, 1) << reader;
  }
}

}  // namespace verify_test
}  // namespace bernal::testing
