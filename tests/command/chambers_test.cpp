#include "check.hpp"
#include "support/meshes.hpp"

namespace bernal::testing {
namespace chambers_test {

constexpr const char* scene = R"(unit = "mm"
[container]
kind = "mesh"
file = "two.off"
[spheres]
count = 20
diameter = 0.5
[[stage]]
do = "insert"
)";

TEST(ChambersOfAFile, AreCountedForARadius) {
  Folder folder;
  const std::string mesh = folder.write("two.off", test::as_off(test::two_cubes_mesh(0.2))).string();
  const Ended narrow = bernal({"inspect", mesh, "--radius", "0.25"});
  EXPECT_EQ(narrow.status, 0) << narrow.err;
  for (const std::string part : {"2 for spheres of radius 0.25", "cannot be covered", "chamber 2"})
    EXPECT_NE(narrow.out.find(part), std::string::npos) << part << "\nis not in\n" << narrow.out;
  const auto wide = nlohmann::json::parse(bernal({"inspect", mesh, "--radius", "0.19", "--json"}).out);
  EXPECT_EQ(wide["chambers"]["radius"], 0.19);
  EXPECT_EQ(wide["chambers"]["list"].size(), 1u);
  EXPECT_TRUE(nlohmann::json::parse(bernal({"inspect", mesh, "--json"}).out)["chambers"].is_null());
  expect_refused_in_one_line(bernal({"inspect", mesh, "--radius", "-1"}), {"--radius", "above 0"});
  expect_refused_in_one_line(bernal({"inspect", mesh, "--radius", "0.25 mm"}), {"--radius", "--unit"});
  const auto in_cm =
      nlohmann::json::parse(bernal({"inspect", mesh, "--unit", "cm", "--radius", "1.9 mm", "--json"}).out);
  EXPECT_EQ(in_cm["chambers"]["radius"], 0.19);
}

TEST(ChambersOfAPacking, StandInEveryReport) {
  Folder folder;
  folder.write("two.off", test::as_off(test::two_cubes_mesh(0.2)));
  const std::string file = folder.write("scene.toml", scene).string(), out = (folder / "out").string();
  const Ended packed = bernal({"pack", file, "-o", out, "--quiet"});
  ASSERT_EQ(packed.status, 0) << packed.err;
  const Ended text = bernal({"measure", out});
  for (const std::string part :
       {"chambers          2, which spheres", "too narrow  ", "packing fraction  position"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\nis not in\n" << text.out;
  EXPECT_NE(text_of(folder / "out/report.html").find("<h2>Chambers</h2>\n<p>There are 2"), std::string::npos);
  for (const auto& found : {nlohmann::json::parse(bernal({"measure", out, "--json"}).out)["chambers"],
                            report_of(folder / "out")["chambers"]}) {
    ASSERT_EQ(found.at("list").size(), 2u);
    std::uint64_t n = 0;
    for (const auto& chamber : found.at("list")) n += chamber.at("n").get<std::uint64_t>();
    EXPECT_EQ(n, 20u);
    EXPECT_EQ(found.at("misplaced"), 0);
    EXPECT_EQ(found.at("uncovered").at("smallest"), found.at("uncovered").at("mean"));
  }
}

}  // namespace chambers_test
}  // namespace bernal::testing
