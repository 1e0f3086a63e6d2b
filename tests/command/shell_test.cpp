// A part that is the wall of a vessel is packed as it is, and whoever meant the hollow sees it at once; so
// does whoever loses a part by a repair.
#include <fmt/format.h>

#include "check.hpp"
#include "support/broken_meshes.hpp"
#include "support/vessels.hpp"

namespace bernal::testing {
namespace shell_test {

using namespace bernal::test;

std::string scene_of(const std::string& mesh, const std::string& spheres, const std::string& line = "") {
  return fmt::format("unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"{}\"\n{}\n[spheres]\n{}\n", mesh,
                     line, spheres);
}

Mesh bucket() { return revolved({{0, 0}, {10, 0}, {12, 24}, {11.5, 24}, {9.5, 1}, {0, 1}}); }

TEST(Shell, IsToldByInspectExplainAndPack) {
  const Folder folder;
  const std::string mesh = folder.write("bucket.off", as_off(bucket())).string();
  const std::string line = "interior = \"cavity\"";

  const Ended inspected = bernal({"inspect", mesh});
  EXPECT_EQ(inspected.status, 0) << inspected.err;
  EXPECT_NE(inspected.out.find("shell with an opening"), std::string::npos) << inspected.out;
  EXPECT_NE(inspected.out.find("in [container]"), std::string::npos) << inspected.out;
  EXPECT_NE(inspected.out.find(line), std::string::npos) << inspected.out;
  const auto json = nlohmann::json::parse(bernal({"inspect", mesh, "--json"}).out);
  EXPECT_EQ(json["container_lines"], nlohmann::json::array({line}));
  EXPECT_NE(json["cautions"][0].get<std::string>().find("shell"), std::string::npos);
  const double hollow = revolved_volume({{9.5, 1}, {11.5, 24}});
  EXPECT_NEAR(json["hollow_volume"].get<double>(), hollow, 1e-9 * hollow);

  const std::string scene = folder.write("scene.toml", scene_of(mesh, "count = 20\ndiameter = 0.3")).string();
  const Ended explained = bernal({"explain", scene});
  EXPECT_NE(explained.out.find("caution"), std::string::npos) << explained.out;
  EXPECT_NE(explained.out.find(line), std::string::npos) << explained.out;
  const std::string out = (folder / "out").string();
  const Ended packed = bernal({"pack", scene, "-o", out});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_NE(packed.err.find(line), std::string::npos) << packed.err;
  EXPECT_NE(report_of(out)["caution"].get<std::string>().find(line), std::string::npos);

  // With the line there is nothing to be said any more.
  const std::string meant =
      folder.write("meant.toml", scene_of(mesh, "count = 20\ndiameter = 3", line)).string();
  EXPECT_EQ(bernal({"pack", meant, "-o", out, "--quiet"}).status, 0);
  EXPECT_TRUE(report_of(out)["caution"].is_null());
  EXPECT_NEAR(report_of(out)["container"]["volume"].get<double>(), hollow, 1e-9 * hollow);
}

TEST(Shell, IsToldWhereNoSphereFitsIntoTheWall) {
  const Folder folder;
  const std::string mesh = folder.write("bucket.off", as_off(bucket())).string();
  const std::string scene = folder.write("scene.toml", scene_of(mesh, "count = 20\ndiameter = 3")).string();
  expect_refused(bernal({"pack", scene, "-o", (folder / "out").string()}),
                 {"scene.toml:8", "does not fit", "shell with an opening", "interior = \"cavity\""});
}

TEST(Shell, ALostExtentIsACaution) {
  // A box with an antenna through its lid, which is thinner than the spheres, and a face is missing.
  Mesh part = divided(box_mesh({0, 0, 0}, {10, 10, 10}), 2);
  append(part, divided(box_mesh({4, 4, 8}, {0.3, 0.3, 12}), 2));
  part.triangles.pop_back();
  const Folder folder;
  const std::string mesh = folder.write("part.off", as_off(part)).string();
  const std::string scene =
      folder.write("scene.toml", scene_of(mesh, "count = 10\ndiameter = 2", "repair = [\"wrap\"]")).string();
  const Ended explained = bernal({"explain", scene});
  EXPECT_EQ(explained.status, 0) << explained.err;
  EXPECT_NE(explained.out.find("caution    repair = [\"wrap\"] lost a part: of 10 x 10 x 20 are left"),
            std::string::npos)
      << explained.out;
  const std::string out = (folder / "out").string();
  EXPECT_EQ(bernal({"pack", scene, "-o", out, "--quiet"}).status, 0);
  EXPECT_NE(report_of(out)["caution"].get<std::string>().find("lost a part"), std::string::npos);
}

}  // namespace shell_test
}  // namespace bernal::testing
