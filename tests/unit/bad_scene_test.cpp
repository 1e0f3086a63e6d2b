#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"

namespace bernal {
namespace bad_scene_test {

using testing::with_container;
using testing::with_spheres;
using testing::with_stage;

struct Bad {
  std::string scene;
  int line;                        ///< 0 where it is the whole file's fault
  std::vector<std::string> words;  ///< that the message contains
};

TEST(BadScene, IsOneLineWithTheFileTheLineAndTheRemedy) {
  const std::string box = "kind = \"box\"\n";
  const std::vector<Bad> bad = {
      // what is no scene at all
      {"", 0, {"empty"}},
      {" \n\t\r\n", 0, {"empty"}},
      {"[container\n", 1, {"TOML"}},
      {"a = 1\na = 2\n", 2, {"TOML"}},
      {"seed = 1\n\n[container]\nkind = \"box\n", 4, {"TOML"}},
      {std::string("\x7f"
                   "ELF\0\1",
                   6),
       1,
       {"TOML"}},
      {"a = \"\xff\xfe\"\n", 1, {"TOML"}},
      // unknown names
      {"sead = 3\n", 1, {"unknown key \"sead\"", "did you mean \"seed\"?"}},
      {"[sphere]\nradius = 1\n", 1, {"\"sphere\"", "did you mean \"spheres\"?"}},
      {"[container]\nkind = \"box\"\n\n[periodic]\n", 4, {"unknown key \"periodic\""}},
      {with_spheres("diametre = 1"),
       3,
       {"unknown key \"diametre\" in [spheres]", "did you mean \"diameter\"?"}},
      {with_spheres("qqqqqqqq = 1"), 3, {"known: \"count\", \"packing_fraction\""}},
      {with_spheres("radius = { distribution = \"uniform\", min = 1, max = 2, \"ba\\nsis\" = 1 }"),
       3,
       {"ba\\u000Asis"}},
      {with_container("kind = \"cylindre\""), 3, {"unknown kind \"cylindre\"", "\"cylinder\"?"}},
      {with_container("kind = \"blob\""), 3, {"unknown kind \"blob\"", "known: \"box\""}},
      {with_container("kind = \"annulus\""), 3, {"unknown kind \"annulus\"", "; did you mean \"tube\"?"}},
      {with_container("kind = \"hopper\""), 3, {"did you mean \"revolved\"?"}},
      {with_container("kind = \"ball\""), 3, {"did you mean \"sphere\"?"}},
      {with_container("kind = \"plane\""), 3, {"did you mean \"polygon\" or \"extruded\"?"}},
      {with_container("kind = \"periodic\""), 4, {"needs a \"count\"", "\"size\""}},
      {with_container("kind = \"periodic\"\nsize = [1.0, 2.0]"), 4, {"\"size\"", "3 dimensions", "has 2"}},
      {with_container("kind = \"periodic\"\nsize = [1, 2, 3]\nedge = 2"), 5, {"exclude each other"}},
      {with_container("kind = \"periodic\"\nsize = [1, 2, 3]\nwalls = [3]"), 5, {"axes", "from 0 to 2"}},
      {with_container("kind = \"periodic\"\nsize = [1, 2, 3]\nwalls = [1, 1]"), 5, {"each once"}},
      {with_container(box + "size = [1, 1, 1]\nradius = 1"), 5, {"unknown key \"radius\" in [container]"}},
      {with_stage("do = \"squeeze\""), 5, {"unknown stage \"squeeze\"", "\"insert\""}},
      {with_stage("do = \"shake\"\nround = 3"), 6, {"[[stage]] shake", "did you mean \"rounds\"?"}},
      {with_spheres("radius = { distribution = \"log-normal\", median = 1 }"),
       3,
       {"did you mean \"lognormal\"?"}},
      // what is missing
      {"[spheres]\nradius = 1\n", 0, {"no [container]"}},
      {"[container]\nkind = \"sphere\"\nradius = 1\n", 0, {"no [spheres]"}},
      {with_container("radius = 1"), 2, {"missing \"kind\"", "\"box\", \"cylinder\", \"mesh\", \"sphere\""}},
      {with_container("kind = \"cylinder\"\nradius = 1"), 2, {"missing \"height\"", "positive length"}},
      {with_spheres("count = 3"), 2, {"exactly one of \"radius\", \"diameter\""}},
      {with_spheres("radius = { median = 1 }"), 3, {"missing \"distribution\"", "\"lognormal\""}},
      {with_spheres("radius = { distribution = \"lognormal\", sigma = 1 }"), 3, {"missing \"median\""}},
      {with_spheres("diameter = { distribution = \"lognormal\" }"),
       3,
       {"exactly one of", "\"d43\" and \"d32\""}},
      {with_spheres("diameter = { distribution = \"lognormal\", d43 = 1 }"), 3, {"missing \"d32\""}},
      {"[container]\nkind = \"mesh\"\nfile = \"a.stl\"\n[spheres]\nradius = 1\n", 1, {"unit = \"mm\""}},
      {with_stage("rounds = 1"), 4, {"missing \"do\""}},
      // alternatives
      {with_spheres("count = 3\nfill = true\nradius = 1"),
       4,
       {"\"count\" and \"fill\"", "exclude each other"}},
      {with_spheres("radius = 1\ndiameter = 1"), 4, {"\"radius\" and \"diameter\"", "exclude each other"}},
      {with_spheres("diameter = { distribution = \"lognormal\", median = 1, d43 = 2 }"),
       3,
       {"exclude each other"}},
      {with_spheres("fill = false\nradius = 1"), 3, {"\"fill\"", "must be true or left out"}},
      // values out of range
      {with_container("kind = \"cylinder\"\nradius = -3\nheight = 1"),
       4,
       {"\"radius\" in [container] must be a positive length, not -3"}},
      {with_container("kind = \"cylinder\"\nradius = nan\nheight = 1"), 4, {"not nan"}},
      {with_container("kind = \"cylinder\"\nradius = inf\nheight = 1"), 4, {"not inf"}},
      {with_container("kind = \"sphere\"\nradius = 0"), 4, {"positive length, not 0"}},
      {with_container("kind = \"sphere\"\nradius = 1e200"), 4, {"1e-30", "1e+30"}},
      {with_container("kind = \"sphere\"\nradius = 1\ncenter = [0, 0, nan]"), 5, {"[0, 0, nan]"}},
      {with_container(box + "size = [1, 2, 3, 4]"), 4, {"three positive lengths", "not [1, 2, 3, 4]"}},
      {with_container(box + "size = [1]"), 4, {"two or three positive lengths", "not [1]"}},
      {with_container(box + "size = [1, 2, 0]"), 4, {"three positive lengths"}},
      {with_container("kind = \"cylinder\"\nradius = 1\nheight = 1\naxis = [0, 0, 0]"),
       6,
       {"\"axis\"", "direction"}},
      {with_container("kind = \"mesh\"\nfile = \"\""), 4, {"path of a file"}},
      {with_container("kind = \"mesh\"\nfile = \"a.stl\"\nunit = \"mn\""),
       5,
       {"\"unit\" in [container] is not \"mn\""}},
      {"unit = \"inch\"\n" + with_spheres("radius = 1"), 1, {"did you mean \"in\"?"}},
      {with_stage("do = \"insert\"\nlayout = \"hexagonal\""), 6, {"did you mean \"hcp\"?"}},
      {"unit = \"furlong\"\n" + with_spheres("radius = 1"), 1, {"\"furlong\"", "\"mm\""}},
      {"seed = -1\n" + with_spheres("radius = 1"), 1, {"\"seed\"", "at least 0, not -1"}},
      {with_spheres("count = 0\nradius = 1"), 3, {"whole number from 1 to 2147483647, not 0"}},
      {with_spheres("count = 2147483648\nradius = 1"), 3, {"not 2147483648"}},
      {with_spheres("count = 99999999999999999999\nradius = 1"), 3, {"TOML"}},
      {with_spheres("packing_fraction = 1.0\nradius = 1"),
       3,
       {"at least 1e-12 and below 1 or \"predicted\", not 1"}},
      {with_spheres("radius = -0.5"), 3, {"\"radius\" in [spheres]", "positive length", "not -0.5"}},
      {with_spheres("radius = { distribution = \"uniform\", min = 2, max = 1 }"), 3, {"2 is not below 1"}},
      {with_spheres("radius = { distribution = \"uniform\", min = 2, max = 2 }"),
       3,
       {"\"min\"", "below \"max\""}},
      {with_spheres("radius = { distribution = \"classes\", values = [], shares = [] }"), 3, {"\"values\""}},
      {with_spheres("radius = { distribution = \"classes\", values = [1, 2], shares = [1] }"),
       3,
       {"1 for 2"}},
      {with_spheres("radius = { distribution = \"classes\", values = [2, 1, 2], shares = [1, 1, 1] }"),
       3,
       {"2 is there twice"}},
      {with_spheres("radius = { distribution = \"classes\", values = [1, 2], shares = [1, -1] }"),
       3,
       {"\"shares\"", "[1, -1]"}},
      {with_spheres("diameter = { distribution = \"lognormal\", d43 = 1, d32 = 2 }"),
       3,
       {"1 is not above 2"}},
      {with_spheres("radius = { distribution = \"lognormal\", d43 = 2, d32 = 1 }"),
       3,
       {"\"d43\" is a diameter", "diameter = {"}},
      {with_spheres("radius = { distribution = \"rosin_rammler\", d63 = 1, n = 1, min = 0.1 }"),
       3,
       {"\"d63\" is a diameter", "diameter = {"}},
      {with_spheres("diameter = { distribution = \"rosin_rammler\", d63 = 1, n = 1 }"),
       3,
       {"\"min\"", "fines"}},
      {with_spheres("diameter = { distribution = \"fuller\", max = 1 }"), 3, {"missing \"min\"", "fines"}},
      {with_spheres("diameter = { distribution = \"fuller\", max = 1, min = 2 }"), 3, {"2 is not below 1"}},
      {with_spheres("radius = { distribution = \"table\" }"), 3, {"\"x\" and \"density\"", "\"file\""}},
      {with_spheres("radius = { distribution = \"table\", x = [1, 2], density = [1] }"), 3, {"1 for 2"}},
      {with_spheres("radius = { distribution = \"table\", x = [1], density = [1] }"), 3, {"two sizes"}},
      {with_spheres("radius = { distribution = \"table\", x = [1, 2], density = [0, 0] }"),
       3,
       {"\"density\"", "0"}},
      {with_spheres("radius = { distribution = \"table\", x = [1, 2], density = [1, -1] }"),
       3,
       {"\"density\"", "at least 0, not [1, -1]"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], passing = [4, 100] }"),
       3,
       {"begin at 0", "4 passes the finest sieve, 1"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], passing = [0, 97] }"),
       3,
       {"100", "97 passes the coarsest sieve, 2"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2, 3], passing = [0, 60, 40] }"),
       3,
       {"60 passes 2 and only 40 passes 3", "\"retained\""}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [0, 2], passing = [4, 100] }"),
       3,
       {"0 at the size 0", "is 4 there"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [2, 1], retained = [30, 70] }"),
       3,
       {"\"retained\"", "0 on the coarsest sieve, but 30 lies on 2", "add the size"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], retained = [70, 0, 30] }"),
       3,
       {"\"retained\"", "only where the sizes fall", "size 0"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [2, 1, 0], retained = [0, 70, 5, 30] }"),
       3,
       {"\"retained\"", "4 for 3"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], retained = [0, 0] }"),
       3,
       {"\"retained\"", "0 everywhere"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], passing = [0, 100], pan = 0.5 }"),
       3,
       {"\"pan\"", "there is none"}},
      {with_spheres(
           "radius = { distribution = \"sieve\", sizes = [2, 1, 0], retained = [0, 70, 30], pan = 1 }"),
       3,
       {"\"pan\"", "1 is not below 1"}},
      {with_spheres("radius = { distribution = \"histogram\", edges = [1, 2], counts = [1, 1] }"),
       3,
       {"\"edges\"", "one more than \"counts\"", "2 for 2"}},
      {with_spheres("radius = { distribution = \"histogram\", edges = [1, 3, 2], masses = [1, 1] }"),
       3,
       {"\"edges\"", "3 stands before 2"}},
      {with_spheres("radius = { distribution = \"histogram\", edges = [0, 1, 2], masses = [1, 1] }"),
       3,
       {"\"edges\"", "begin above 0", "smallest size"}},
      {with_spheres("radius = { distribution = \"histogram\", edges = [1, 2], counts = [0] }"),
       3,
       {"\"counts\"", "0 everywhere"}},
      {with_spheres("radius = { distribution = \"histogram\", edges = [1, 2], counts = [1], masses = [1] }"),
       3,
       {"exclude each other"}},
      {with_spheres("radius = { distribution = \"percentiles\", d10 = 1, d90 = 2 }"),
       3,
       {"\"d10\" is a diameter", "diameter = {"}},
      {with_spheres("diameter = { distribution = \"percentiles\", d50 = 2 }"),
       3,
       {"two percentiles or more", "\"sigma\""}},
      {with_spheres("diameter = { distribution = \"percentiles\", d10 = 1, d50 = 3, d90 = 2 }"),
       3,
       {"\"d90\"", "above \"d50\"", "2 is not above 3"}},
      {with_spheres(
           "diameter = { distribution = \"percentiles\", d10 = 1, d90 = 2, law = \"rosin_rammler\" }"),
       3,
       {"needs \"min\"", "1 % of this fit lies below 0.59"}},
      {with_spheres(
           "diameter = { distribution = \"percentiles\", d10 = 1, d90 = 2, law = \"through\", min = 1 }"),
       3,
       {"\"min\"", "below all percentiles"}},
      {with_spheres("diameter = { distribution = \"percentiles\", d10 = 1, d50 = 1.01, d90 = 100 }"),
       3,
       {"no lognormal law", "4.66", "\"d50\"", "\"through\""}},
      {with_spheres(
           "diameter = { distribution = \"percentiles\", d16 = \"0.9 phi\", d50 = \"1.5 phi\", d84 = "
           "\"2.1 phi\" }"),
       3,
       {"above \"d16\"", "the larger number is the finer grain"}},
      {with_spheres(
           "radius = { distribution = \"sieve\", sizes = [2, 1], retained = [0, 1], passing = [100, 0] }"),
       3,
       {"\"passing\" and \"retained\""}},
      {with_spheres("radius = { distribution = \"lognormal\", mean = 3, sd = 1e-20 }"),
       3,
       {"\"sd\"", "1e-07"}},
      {with_spheres("radius = { distribution = \"lognormal\", d10 = 3, d90 = 4 }"),
       3,
       {"\"d10\"", "distribution = \"percentiles\""}},
      {with_spheres("radius = { distribution = \"list\", values = [1, 0] }"), 3, {"\"values\"", "positive"}},
      {with_spheres("count = 3\nradius = { distribution = \"list\", values = [1, 2] }"),
       3,
       {"\"count\"", "says 3", "2 sizes", "resample"}},
      {with_spheres("fill = true\nradius = { distribution = \"list\", values = [1, 2] }"),
       3,
       {"how many spheres there are, 2", "resample"}},
      {with_spheres("radius = { distribution = \"list\", values = [1, 2] }\ndraw = \"random\""),
       4,
       {"\"random\"", "resample"}},
      {with_spheres(
           "radius = { distribution = \"mixture\", shares = [1, 1], of = [1, { distribution = \"list\", "
           "values = [1, 2] }] }"),
       3,
       {"in a mixture", "resample"}},
      {with_spheres("radius = { distribution = \"list\", values = [1, 2], file = \"a.csv\" }"),
       3,
       {"exclude each other"}},
      {with_spheres("radius = { distribution = \"list\", file = \"nowhere.csv\" }"),
       3,
       {"\"file\"", "there is no file"}},
      {with_spheres("radius = { distribution = \"classes\", values = [1, 2], shares = [1, 2], "
                    "material_densities = [2500] }"),
       3,
       {"\"material_densities\"", "1 for 2"}},
      {with_spheres(
           "radius = { distribution = \"classes\", values = [1, 2], shares = [1, 2], names = [\"a\"] }"),
       3,
       {"\"names\"", "one name for each", "1 for 2"}},
      {with_spheres("radius = { distribution = \"mixture\", of = [], shares = [1] }"),
       3,
       {"\"of\"", "array"}},
      {with_spheres("radius = { distribution = \"mixture\", of = [1, 2], shares = [1] }"),
       3,
       {"\"shares\" in radius of [spheres]", "1 for 2"}},
      {with_spheres("radius = { distribution = \"mixture\", of = [1, -2], shares = [1, 1] }"),
       3,
       {"\"part 2\" in radius of [spheres]", "positive length", "not -2"}},
      {with_spheres("radius = { distribution = \"mixture\", shares = [1], of = [\n{ distribution = "
                    "\"uniform\", min = 1 }] }"),
       4,
       {"missing \"max\" in part 1 of radius of [spheres]"}},
      {with_spheres("radius = { distribution = \"mixture\", shares = [1], of = [\n{ distribution = "
                    "\"lognormal\", d43 = 2, d32 = 1 }] }"),
       4,
       {"\"d43\" is a diameter"}},
      {with_spheres("radius = 1\ndraw = \"quantile\""), 4, {"\"draw\"", "did you mean \"quantiles\"?"}},
      {with_spheres("radius = 1\n[accuracy]\noverlap = -1e-9"), 5, {"\"overlap\"", "at least 0"}},
      {with_spheres("radius = 1\n[accuracy]\nwalls = \"exakt\""),
       5,
       {"\"walls\"", "did you mean \"exact\"?"}},
      {with_stage("do = \"compress\"\ndirection = [0, 0, 0]"), 6, {"\"direction\" in [[stage]] compress"}},
      // wrong types
      {with_container("kind = 3"), 3, {"\"kind\"", "not 3"}},
      {with_container("kind = \"sphere\"\nradius = \"1\""), 4, {"positive length, not \"1\""}},
      {with_container(box + "size = 3"), 4, {"not 3"}},
      {with_container(box + "size = [1, \"2\", 3]"), 4, {"[1, \"2\", 3]"}},
      {"container = 4\n[spheres]\nradius = 1\n", 1, {"must be a table [container], not 4"}},
      {"[[container]]\nkind = \"box\"\n[spheres]\nradius = 1\n", 1, {"must be a table [container]"}},
      {with_spheres("radius = true"), 3, {"{ distribution = "}},
      {with_spheres("radius = [1, 2]"), 3, {"not [1, 2]"}},
      {with_spheres("count = 1.5\nradius = 1"), 3, {"whole number", "not 1.5"}},
      {with_spheres("count = \"" + std::string(1000, 'x') + "\"\nradius = 1"), 3, {"xxx\"…"}},
      {with_spheres("radius = 1\n[stage]\ndo = \"insert\""), 4, {"[[stage]]"}},
      {with_spheres("radius = 1\n[stage.insert]"), 4, {"[[stage]]"}},
      {"stage = []\n" + with_spheres("radius = 1"), 1, {"[[stage]]"}},
      {"stage = [1]\n" + with_spheres("radius = 1"), 1, {"[[stage]]"}},
  };
  for (const Bad& b : bad) {
    SCOPED_TRACE(b.scene);
    try {
      parse_scene(b.scene, "folder/scene.toml");
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      EXPECT_TRUE(what.starts_with(b.line > 0 ? fmt::format("folder/scene.toml:{}: ", b.line)
                                              : "folder/scene.toml: "))
          << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_LT(what.size(), 380u) << what;
      for (const std::string& word : b.words)
        EXPECT_NE(what.find(word), std::string::npos) << word << "\nis not in: " << what;
    }
  }
}

// A parser that comes back from forty thousand tables in tables runs out of stack.
TEST(BadScene, KeysOfManyPartsAreRefused) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      parse_scene(text, "scene.toml");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  std::string deep = "x", quoted = "\"x\"";
  for (int part = 1; part < 40'000; ++part) {
    deep += ".x";
    quoted += " . 'x'";
  }
  for (const std::string& text :
       {deep + " = 1\n", "[" + deep + "]\n", "a = { " + deep + " = 1 }\n", quoted + " = 1\n"})
    EXPECT_NE(refusal("seed = 1\n" + text).find("scene.toml:2: a key has more than 32 parts"),
              std::string::npos)
        << text.substr(0, 20);
  std::string numbers = "seed = 1 # 1.2.3. and " + std::string(100, '.') + "\na = [0.5", dots(100, '.');
  for (int k = 0; k < 100; ++k) numbers += ", 0.5";
  const std::string said = refusal(numbers + "]\nb = \"" + dots + "\"\n");
  EXPECT_EQ(said.find("parts"), std::string::npos) << said;
}

TEST(BadScene, FileIsNamed) {
  const testing::Folder folder;
  const auto refusal = [](const std::filesystem::path& file) -> std::string {
    try {
      read_scene(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string missing = (folder / "none.toml").string();
  EXPECT_EQ(refusal(missing), missing + ": no such scene file");
  EXPECT_EQ(refusal(folder.path()), folder.path().string() + ": this is a folder, not a scene file");
  const auto large = folder.write("large.toml", std::string(2 << 20, '#'));
  EXPECT_NE(refusal(large).find("larger than 1 MiB"), std::string::npos);
}

}  // namespace bad_scene_test
}  // namespace bernal
