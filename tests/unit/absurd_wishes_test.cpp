// Scenes that ask for what there is not: numbers beyond all measure, spheres that fit nowhere, packings
// denser than any.
#include <gtest/gtest.h>

#include <cmath>

#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "support/starts.hpp"

namespace bernal {
namespace absurd_wishes_test {

using namespace testing::starts;
using testing::error_of;

class AbsurdWishes : public StartFixture {
 protected:
  std::string caution(const std::string& toml) const { return build(scene(toml)).caution; }
  void expect_refused(const std::string& toml, const std::vector<std::string>& words) const {
    SCOPED_TRACE(toml);
    const Error error = error_of([&] { packed(toml); });
    EXPECT_GT(error.location().line, 0) << error.what();
    for (const std::string& word : words)
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << word << " not in " << error.what();
  }
};

std::string equal_in(int dimension, const std::string& more = "", const std::string& at_end = "") {
  return fmt::format(
      "[container]\nkind = \"periodic\"\ndimension = {}\n[spheres]\ncount = 40\nradius = 1\n{}{}", dimension,
      more, at_end);
}

// What is written could not be read back, or the run ended in a crash or with words of the standard library.
TEST_F(AbsurdWishes, NumbersBeyondAllMeasureHaveALineAndARemedy) {
  for (const std::string x : {"5e-324", "1e-300", "1e-30", "-0.0", "0", "-1", "nan", "inf", "1", "1e300"}) {
    for (const int dimension : {1, 3, 5})
      expect_refused(equal_in(dimension, "packing_fraction = " + x + "\n"), {"packing_fraction", "1e-12"});
    expect_refused(equal_in(3, "", stage("relax", "phi0 = " + (x == "1" ? "11" : x) + "\n")), {"phi0"});
    expect_refused(equal_in(3, "", stage("grow", "phi_init = " + x + "\n")), {"phi_init"});
    expect_refused(equal_in(3, "", stage("grow", "delta = " + (x == "1" ? "1e-9" : x) + "\n")), {"delta"});
    expect_refused(
        box + "[spheres]\ncount = 3\nradius = 1\n" + stage("insert", "packing_fraction = " + x + "\n"),
        {"packing_fraction"});
  }
  for (const std::string x : {"-1", "nan", "inf", "1e31", "1e300"})
    for (const std::string key : {"gap", "wall_gap"})
      expect_refused(equal_in(3, key + " = " + x + "\n"), {"\"" + key + "\""});
  for (const int dimension : {2, 3})
    expect_refused(equal_in(dimension, "gap = 1e30\n"), {"1e+29", "check the units"});
  expect_refused(
      "[container]\nkind = \"box\"\ncorner = [1e30, 0, 0]\nsize = [1e30, 1e30, 1e30]\n[spheres]\ncount = "
      "1\nradius = 1e29\n",
      {"from the origin", "check the units"});
  expect_refused("seed = 1e18\n" + equal_in(3), {"seed"});  // of which no double says the last digits
}

// What is just possible is packed, certified and read back.
TEST_F(AbsurdWishes, WhatIsJustPossibleIsReadBack) {
  for (const std::string& toml :
       {equal_in(3, "packing_fraction = 1e-12\n"), equal_in(1, "packing_fraction = 1e-12\n"),
        equal_in(5, "packing_fraction = 1e-12\n", stage("fly")), equal_in(3, "gap = 1e28\n"),
        equal_in(3, "gap = 5e-324\n"), equal_in(3, "packing_fraction = 1e-9\n", stage("grow")),
        equal_in(3, "", stage("relax", "phi0 = 1e-12\n"))}) {
    SCOPED_TRACE(toml);
    const Packing packing = packed(toml);
    EXPECT_EQ(packing.spheres.size(), 40U);
    const WrittenPacking written = write_packing(packing, folder / "out");
    EXPECT_TRUE(written.certificate.certified) << written.certificate.statement;
    EXPECT_EQ(read_packing(folder / "out").spheres, packing.spheres);
  }
}

TEST_F(AbsurdWishes, ASphereAsWideAsItsPeriodicBoxIsPlaced) {
  const auto in = [](const std::string& size, int count, int dimension = 3) {
    return fmt::format(
        "[container]\nkind = \"periodic\"\ndimension = {}\nsize = {}\n[spheres]\ncount = {}\nradius = 1\n",
        dimension, size, count);
  };
  for (const std::string& toml :
       {in("[2, 2, 2]", 1), in("[2, 2, 4]", 1), in("[4, 2, 2]", 2), in("[2, 4, 2]", 2), in("[6, 2, 2]", 3),
        in("[2, 2]", 1, 2), in("[4, 2]", 2, 2), in("[2, 2, 2, 2]", 1, 4), in("[2.5, 2, 2]", 1)}) {
    SCOPED_TRACE(toml);
    const Packing packing = packed(toml);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_EQ(std::get<PeriodicBox>(packing.scene.container).size,
              std::get<PeriodicBox>(scene(toml).container).size);
    expect_certified(packing);
  }
  const Packing too_many = packed(in("[4, 2, 2]", 3));
  EXPECT_EQ(too_many.outcome, Outcome::full) << too_many.reason;
}

TEST_F(AbsurdWishes, WhatIsDenserThanAnyIsSaid) {
  EXPECT_EQ(caution(equal_in(3, "packing_fraction = 0.6\n")).find("asked for"), std::string::npos);
  EXPECT_NE(caution(equal_in(3, "packing_fraction = 0.7\n")).find("expected to reach 0.64"),
            std::string::npos)
      << caution(equal_in(3, "packing_fraction = 0.7\n"));
  EXPECT_EQ(caution(equal_in(3, "packing_fraction = 0.7\n")).find("arrangement"), std::string::npos);
  EXPECT_NE(caution(equal_in(3, "packing_fraction = 0.8\n")).find("has more than 0.7405"), std::string::npos);
  EXPECT_NE(
      caution(equal_in(2, "packing_fraction = 0.95\n")).find("discs that is known has more than 0.9069"),
      std::string::npos);
  EXPECT_NE(caution(equal_in(5, "packing_fraction = 0.5\n")).find("0.4653"), std::string::npos);
  EXPECT_NE(caution(periodic(10, "[spheres]\ncount = 190\nradius = 1\n")).find("by the count"),
            std::string::npos);
  const std::string two_sizes =
      "[container]\nkind = \"periodic\"\n[spheres]\ncount = 4000\npacking_fraction = 0.76\nradius = { "
      "distribution = "
      "\"classes\", values = [1, 5], shares = [1, 4], basis = \"volume\" }\n";
  EXPECT_EQ(caution(two_sizes).find("asked for"), std::string::npos) << caution(two_sizes);
  EXPECT_NE(caution("[container]\nkind = \"cylinder\"\nradius = 5\nheight = 20\n[spheres]\npacking_fraction "
                    "= 0.75\nradius = "
                    "0.5\n")
                .find("asked for"),
            std::string::npos);
}

/// A cube of edge 100 whose walls are 5 thick.
std::string hollow_cube() {
  std::string vertices, faces;
  for (const int inset : {0, 5})
    for (int k = 0; k < 8; ++k) {
      const auto x = [&](int bit) { return (k >> bit & 1) != 0 ? 100 - inset : inset; };
      vertices += fmt::format("{} {} {}\n", x(0), x(1), x(2));
    }
  constexpr int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : quads) {
    faces += fmt::format("3 {} {} {}\n3 {} {} {}\n", a, b, c, a, c, d);
    faces += fmt::format("3 {} {} {}\n3 {} {} {}\n", c + 8, b + 8, a + 8, d + 8, c + 8, a + 8);
  }
  return "OFF\n16 24 0\n" + vertices + faces;
}

// In a corner a sphere touches three faces and the corner of the hollow: r = 5 sqrt(3) / (1 + sqrt(3)).
TEST_F(AbsurdWishes, WhatFitsNowhereNamesTheLargestThatFits) {
  folder.write("cube.off", hollow_cube());
  const double largest = 10 * std::sqrt(3.0) / (1 + std::sqrt(3.0));
  const auto of = [](double diameter) {
    return fmt::format(
        "unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"cube.off\"\n[spheres]\nfill = true\n"
        "diameter = {}\n",
        diameter);
  };
  for (const double share : {1.5, 3.0}) expect_refused(of(share * largest), {"does not fit", "6.339"});
  // So little larger that it is not proven: a caution, and numbers that are some.
  const Plan hardly = build(scene(of(1.01 * largest)));
  EXPECT_NE(hardly.caution.find("no place is known"), std::string::npos) << hardly.caution;
  EXPECT_NE(hardly.caution.find("6.339"), std::string::npos) << hardly.caution;
  EXPECT_TRUE(std::isfinite(hardly.expected_seconds));
  const Plan plan = build(scene(of(0.99 * largest)));
  EXPECT_EQ(plan.caution, "");
  EXPECT_TRUE(std::isfinite(plan.expected_seconds));
  EXPECT_GT(plan.expected_count, 0);
}

TEST_F(AbsurdWishes, AMeanOfLognormalSizesIsTakenAndItsOtherNamesAreTold) {
  const auto of = [](const std::string& keys) {
    return equal_in(3).replace(equal_in(3).find("radius = 1"), 10,
                               "radius = { distribution = \"lognormal\", " + keys + " }");
  };
  const auto sizes = radii_of(scene(of("mean = 3, sd = 0.8")));
  EXPECT_NEAR(sizes->moment(1), 3, 1e-14);
  EXPECT_NEAR(std::sqrt(sizes->moment(2) - 9), 0.8, 1e-14);
  expect_refused(of("mean = 3"), {"missing \"sd\""});
  expect_refused(of("mean = 3, sigma = 0.2"), {"\"mean\"", "\"sigma\"", "exclude each other"});
  expect_refused(of("mean = 3, std = 0.8"), {"\"std\"", "is \"sd\""});
  expect_refused(of("mean = 3, variance = 0.64"), {"\"variance\"", "here sd = 0.8"});
  expect_refused(of("mean = 3, cv = 0.2"), {"\"cv\"", "here sd = 0.6"});
  expect_refused(of("d50 = 3, sigma = 0.2"), {"\"d50\"", "basis = \"volume\"", "percentiles"});
  const Error error = error_of([&] { scene(of("mean = 3, std = 0.8")); });
  EXPECT_EQ(std::string(error.what()).find("did you mean"), std::string::npos) << error.what();
}

TEST_F(AbsurdWishes, AStartIsCheckedBeforeItIsRun) {
  folder.write("bad.csv", "x,y,z,r\n2,2,2,1\n2,2,3,1\n");
  folder.write("out.csv", "x,y,z,r\n2,2,2,1\n2,2,20,1\n");
  folder.write("two.csv", two);
  const auto with = [&](const std::string& file) {
    return build(scene(box + "[spheres]\nstart = \"" + file + "\"\n" + stage("compress")));
  };
  EXPECT_NO_THROW(check_start(with("two.csv")));
  for (const std::string file : {"bad.csv", "out.csv"}) {
    const std::string said = error_of([&] { check_start(with(file)); }).what();
    EXPECT_EQ(said, error_of([&] { run(with(file)); }).what());
    EXPECT_NE(said.find(file + ":3"), std::string::npos) << said;
  }
}

TEST_F(AbsurdWishes, AResultHasOneFileOfSpheres) {
  write_packing(packed(equal_in(3)), folder / "out");
  EXPECT_NO_THROW(read_packing(folder / "out"));
  std::ofstream(folder / "out/spheres.npy") << "damaged";
  const Error error = error_of([&] { read_packing(folder / "out"); });
  EXPECT_NE(std::string(error.what()).find("spheres.csv and spheres.npy"), std::string::npos) << error.what();
  EXPECT_NE(refusal(equal_in(3).replace(equal_in(3).find("radius = 1"), 10, "radius = 1\nstart = \"out\""))
                .find("spheres.npy"),
            std::string::npos);
}

}  // namespace absurd_wishes_test
}  // namespace bernal
