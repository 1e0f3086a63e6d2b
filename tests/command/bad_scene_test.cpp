#include "check.hpp"
#include "support/scenes.hpp"

namespace bernal::testing {
namespace bad_scene_test {

/// Every subcommand that reads a scene refuses it in one line, and nothing is written.
void expect_bad_scene(const std::filesystem::path& scene, const std::vector<std::string>& words) {
  const Folder folder;
  expect_refused_in_one_line(bernal({"pack", scene.string(), "-o", (folder / "out").string()}), words);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  expect_refused_in_one_line(bernal({"explain", scene.string()}), words);
  expect_refused_in_one_line(bernal({"explain", scene.string(), "--json"}), words);
}

TEST(BadScene, FileThatIsNoScene) {
  const Folder folder;
  expect_bad_scene(folder / "none.toml", {"none.toml", "no such scene file"});
  expect_bad_scene(folder.path(), {"folder"});
  expect_bad_scene(folder.write("empty.toml", ""), {"empty.toml", "empty"});
  expect_bad_scene(folder.write("garbage.toml", std::string("\x7f"
                                                            "ELF\x02\0\0\xff\xfe",
                                                            9)),
                   {"garbage.toml:1", "TOML"});
  const std::string whole = text_of(BERNAL_DATA "/scenes/hopper.toml");
  expect_bad_scene(folder.write("cut.toml", whole.substr(0, whole.find("distribution"))),
                   {"cut.toml:", "TOML"});
  expect_bad_scene(BERNAL_DATA "/meshes/hopper.stl", {"hopper.stl"});
}

TEST(BadScene, AbsurdValues) {
  const Folder folder;
  const auto scene_with = [&](const std::string& before, const std::string& after) {
    std::string text = small_scene;
    text.replace(text.find(before), before.size(), after);
    return folder.write("scene.toml", text);
  };
  expect_bad_scene(scene_with("diameter = 1", "diametre = 1"),
                   {"scene.toml:7", "unknown key \"diametre\" in [spheres]; did you mean \"diameter\"?"});
  expect_bad_scene(scene_with("diameter = 1", "diameter = -1"), {"scene.toml:7", "positive length"});
  expect_bad_scene(scene_with("diameter = 1", "diameter = nan"), {"scene.toml:7", "nan"});
  expect_bad_scene(scene_with("count = 300", "count = 0"), {"scene.toml:6", "count"});
  expect_bad_scene(scene_with("count = 300", "count = 1000000000000"), {"scene.toml:6", "count"});
  expect_bad_scene(scene_with("[10, 10, 10]", "[10, inf, 10]"), {"scene.toml:4", "size"});
  expect_bad_scene(scene_with("\"mm\"", "\"parsec\""), {"scene.toml:1", "parsec"});
}

TEST(BadScene, SphereLargerThanItsContainer) {
  const Folder folder;
  for (const std::string container :
       {"kind = \"box\"\nsize = [10, 10, 1]", "kind = \"sphere\"\nradius = 0.5",
        "kind = \"cylinder\"\nradius = 9\nheight = 1", "kind = \"cylinder\"\nradius = 0.5\nheight = 9"})
    expect_bad_scene(
        folder.write("scene.toml", "[container]\n" + container + "\n[spheres]\ndiameter = 1.001\n"),
        {"scene.toml:", "does not fit", "diameter"});
}

TEST(BadScene, MeshThatIsNotThereOrIsNone) {
  const Folder folder;
  const auto scene = folder.write(
      "scene.toml",
      "unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"part.stl\"\n[spheres]\nradius = 1\n");
  expect_bad_scene(scene, {"part.stl"});
  folder.write("part.stl", "");
  expect_bad_scene(scene, {"part.stl"});
  folder.write("part.stl", "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0");
  expect_bad_scene(scene, {"part.stl"});
  folder.write("part.stl",
               "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
               "endloop\nendfacet\nendsolid part\n");
  expect_bad_scene(scene, {"part.stl", "open"});
}

TEST(Explain, PrintsTheProtocolOfASceneThatNamesNone) {
  const Folder folder;
  const auto scene = folder.write("scene.toml", small_scene);
  const Ended text = bernal({"explain", scene.string()});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.err, "");
  for (const std::string word : {"box", "mm", "diameter", "[[stage]]\ndo = \"relax\"", "patience = 12"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word << "\nis not in:\n" << text.out;

  // What it prints can be pasted.
  const auto pasted = folder.write("pasted.toml", small_scene + text.out.substr(text.out.find("[[stage]]")));
  const Ended again = bernal({"explain", pasted.string()});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out.find("[[stage]]"), std::string::npos);

  const Ended json = bernal({"explain", scene.string(), "--json"});
  EXPECT_EQ(json.status, 0);
  const auto plan = nlohmann::json::parse(json.out);
  EXPECT_EQ(plan["unit"], "mm");
  EXPECT_EQ(plan["container"]["kind"], "box");
  EXPECT_NEAR(plan["container"]["volume"].get<double>(), 1000, 1e-9);
  EXPECT_EQ(plan["stages_are_default"], true);
  EXPECT_GT(plan["expected"]["count"].get<double>(), 0);
  EXPECT_FALSE(plan["items"].empty());
}

TEST(Explain, SaysWhatAMixtureIsMadeOf) {
  const Folder folder;
  std::string text = small_scene;
  const std::string before = "diameter = 1";
  text.replace(text.find(before), before.size(),
               "draw = \"quantiles\"\ndiameter = { distribution = \"mixture\", shares = [1, 3], "
               "of = [1, { distribution = \"fuller\", min = 1, max = 2 }] }");
  const Ended ended = bernal({"explain", folder.write("scene.toml", text).string()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find(
                "diameter in mm: mixture, of (constant, value 1) and (fuller, max 2, exponent 0.5, min 1), "
                "shares [1, 3], basis number; drawn by quantiles"),
            std::string::npos)
      << ended.out;
}

TEST(Explain, EveryExampleScene) {
  for (const auto& scene : example_scenes()) {
    const Ended text = bernal({"explain", scene.string()});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_NE(text.out.find("What would run:"), std::string::npos) << text.out;
  }
}

}  // namespace bad_scene_test
}  // namespace bernal::testing
