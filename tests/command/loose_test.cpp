// What jams well below random close packing of its sizes ends loose, with exit code 3 and the reason; explain
// says before that the box is too small for its largest spheres.
#include <fmt/format.h>

#include "check.hpp"

namespace bernal::testing {
namespace loose_test {

/// Two sizes 1 : 10 in a periodic box, a quarter of the volume small: 300 spheres hold one large one, which
/// its own images keep from being packed closer than 0.7.
std::string two_sizes(int count, const std::string& more = "") {
  return fmt::format(
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\ndiameter = {{ distribution = \"classes\", "
      "values "
      "= [1, 10], shares = [25, 75], basis = \"volume\" }}\n{}",
      count, more);
}

TEST(Loose, IsAnEndOfItsOwnThatSaysWhy) {
  const Folder folder;
  const std::string out = (folder / "out").string();
  const Ended packed = bernal({"pack", folder.write("scene.toml", two_sizes(300)).string(), "-o", out});
  EXPECT_EQ(packed.status, 3) << packed.err;
  const auto report = report_of(out);
  EXPECT_EQ(report["outcome"], "loose");
  EXPECT_EQ(report["certified"], true);
  EXPECT_EQ(report["n"], 300);
  EXPECT_GT(report["expected_phi_of_sizes"].get<double>(), report["phi"].get<double>() + 0.05);
  const std::string reason = report["reason"];
  for (const std::string word : {"all 300 spheres are placed", "below the 0.8", "1 sphere", "across",
                                 "11,000 spheres would be enough"})
    EXPECT_NE(reason.find(word), std::string::npos) << word << "\nis not in: " << reason;
  EXPECT_NE(packed.err.find("loose: all 300"), std::string::npos) << packed.err;
  const std::string page = text_of(folder / "out/report.html");
  EXPECT_NE(page.find("loose: all 300"), std::string::npos);
  // At first sight: nothing is green, though it is certified.
  EXPECT_NE(page.find("class=\"statement short\""), std::string::npos);
  EXPECT_NE(page.find("<b class=\"short\">yes</b>"), std::string::npos);
  EXPECT_EQ(page.find("class=\"yes\""), std::string::npos);
  EXPECT_EQ(page.find("class=\"statement\""), std::string::npos);
  EXPECT_EQ(packed.err.find("\x1b"), std::string::npos);  // colours are for terminals
  EXPECT_EQ(bernal({"verify", out}).status, 0);

  // What was drawn stands beside what was asked, and in the scene as it ran.
  ASSERT_EQ(report["sizes"]["shares"].size(), 2u);
  EXPECT_EQ(report["sizes"]["shares"][1]["count"], 1);
  EXPECT_NEAR(report["sizes"]["shares"][1]["asked_volume"].get<double>(), 0.75, 1e-9);
  EXPECT_NEAR(report["sizes"]["shares"][1]["volume"].get<double>(), 1000.0 / 1299, 1e-9);
  EXPECT_NE(text_of(folder / "out/scene.toml").find("draw = \"quantiles\""), std::string::npos);
}

/// Growth knows no box narrower than two and a half of the largest spheres.
TEST(Growth, SaysThatItsBoxHasBecomeTooNarrow) {
  const Folder folder;
  const std::string scene =
      "[container]\nkind = \"periodic\"\ndimension = 5\n[spheres]\ncount = 60\nradius = 1\n"
      "[[stage]]\ndo = \"grow\"\n";
  const std::string out = (folder / "out").string();
  EXPECT_EQ(bernal({"pack", folder.write("scene.toml", scene).string(), "-o", out}).status, 3);
  const std::string reason = report_of(out)["reason"];
  EXPECT_NE(reason.find("2.5 of the largest diameters wide"), std::string::npos) << reason;
}

TEST(Loose, IsToldByHelp) { EXPECT_NE(bernal({"pack", "--help"}).out.find("loose"), std::string::npos); }

TEST(Loose, ALoosePackingThatIsAskedForIsNone) {
  const Folder folder;
  const std::string scene =
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 1000\nradius = 1\n"
      "[[stage]]\ndo = \"relax\"\nphi0 = 0.57\n";
  const std::string out = (folder / "out").string();
  EXPECT_EQ(bernal({"pack", folder.write("scene.toml", scene).string(), "-o", out, "--quiet"}).status, 0);
  EXPECT_EQ(report_of(out)["outcome"], "converged");
  const std::string page = text_of(folder / "out/report.html");
  EXPECT_NE(page.find("<b class=\"yes\">yes</b>"), std::string::npos);
  EXPECT_EQ(page.find("class=\"short\""), std::string::npos);
  EXPECT_LT(report_of(out)["phi"].get<double>(), 0.575);
}

TEST(Loose, ExplainSaysBeforeThatTheLargestAreTooFew) {
  const Folder folder;
  const auto explained = [&](const std::string& scene) {
    return bernal({"explain", folder.write("scene.toml", scene).string()}).out;
  };
  const std::string few = explained(two_sizes(3000));
  EXPECT_NE(few.find("\ncaution    half of the volume is in 9 spheres and the box is 2.0 of the largest "
                     "diameters across: too few to pack at random; 11,000 spheres would be enough\n"),
            std::string::npos)
      << few;
  EXPECT_EQ(explained(two_sizes(11'000)).find("caution"), std::string::npos);
  EXPECT_EQ(explained(two_sizes(3000, "packing_fraction = 0.4\n")).find("caution"), std::string::npos);
  const Ended json = bernal({"explain", (folder / "scene.toml").string(), "--json"});
  EXPECT_TRUE(nlohmann::json::parse(json.out)["caution"].is_null());
}

}  // namespace loose_test
}  // namespace bernal::testing
