// Sizes as people say them: percentiles, what sieves retain, histograms, classes weighed out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/sizes/percentiles.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"

namespace bernal {
namespace size_wishes_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nine_tenths = 1.2815515655446004;  ///< where nine tenths of a normal distribution lie below

Scene scene_of(const std::string& spheres) { return parse_scene(testing::with_spheres(spheres), "s.toml"); }

std::unique_ptr<SizeDistribution> diameters_of(const std::string& keys) {
  return radii_of(scene_of("radius = { distribution = " + keys + " }"));
}

TEST(Percentiles, OfALognormalLawAreItsClosedForm) {
  // D10 and D90 are the median times e^(∓1.2816 sigma), d43 the median by volume times e^(sigma²/2), and d32
  // times e^(-sigma²/2).
  const std::vector<Percentile> ends = {{0.1, 1}, {0.9, 4}};
  const double sigma = std::log(4) / (2 * nine_tenths);
  const FittedLaw law = fit_law(ends, PercentileLaw::lognormal);
  EXPECT_NEAR(law.place, 2, 1e-14);
  EXPECT_NEAR(law.spread, sigma, 1e-14);
  const auto sizes = make_from_percentiles(ends, PercentileLaw::lognormal, Basis::volume, 0, infinity);
  EXPECT_NEAR(sizes->moment(4) / sizes->moment(3), 2 * std::exp(sigma * sigma / 2), 1e-12);
  EXPECT_NEAR(sizes->moment(3) / sizes->moment(2), 2 * std::exp(-sigma * sigma / 2), 1e-12);
}

TEST(Percentiles, OfRosinAndRammlerAreTheirClosedForm) {
  // 1 - exp(-(D50 / d63)^n) = 1/2, so d63 = D50 / ln(2)^(1/n); and d63 has 1 - 1/e below.
  const double n = 1.7, d63 = 3;
  const auto at = [&](double p) { return d63 * std::pow(-std::log(1 - p), 1 / n); };
  const FittedLaw law =
      fit_law({{0.1, at(0.1)}, {0.5, at(0.5)}, {0.9, at(0.9)}}, PercentileLaw::rosin_rammler);
  EXPECT_NEAR(law.place, d63, 1e-14);
  EXPECT_NEAR(law.spread, n, 1e-14);
  EXPECT_NEAR(law.size_at(PercentileLaw::rosin_rammler, 1 - std::exp(-1)), d63, 1e-14);
}

TEST(Percentiles, AreMetExactlyByTwoAndByACurveThroughThem) {
  const std::vector<Percentile> two = {{0.16, 1.8}, {0.84, 2.2}},
                                many = {{0.05, 1}, {0.5, 3}, {0.6, 3.1}, {0.95, 8}};
  for (const Basis basis : {Basis::number, Basis::volume}) {
    for (const PercentileLaw law : {PercentileLaw::lognormal, PercentileLaw::normal}) {
      const auto sizes = make_from_percentiles(two, law, basis, 0, infinity);
      // A normal distribution is cut where 1e-9 of it lies beyond.
      for (const auto& [share, size] : two)
        EXPECT_NEAR(radius_below(*sizes, share, basis), size, 2e-6 * size);
    }
    const auto sizes = make_from_percentiles(many, PercentileLaw::through, basis, 0, infinity);
    for (const auto& [share, size] : many) EXPECT_NEAR(radius_below(*sizes, share, basis), size, 2e-5 * size);
    const auto ended = make_from_percentiles(many, PercentileLaw::through, basis, 0.5, 9);
    EXPECT_EQ(ended->min(), 0.5);
    EXPECT_EQ(ended->max(), 9);
    for (const auto& [share, size] : many) EXPECT_NEAR(radius_below(*ended, share, basis), size, 2e-5 * size);
  }
}

// The line of least squares of ln d over z: with z = -x, 0, x its slope is (ln D90 - ln D10) / 2x and its
// middle the mean of all three.
TEST(Percentiles, OfThreeAreFittedAndTheDeviationIsSaid) {
  const Scene scene =
      scene_of("count = 9\ndiameter = { distribution = \"percentiles\", d10 = 1, d50 = 2, d90 = 3.5 }");
  const auto radii = radii_of(scene);
  const double median = std::cbrt(1 * 2 * 3.5), sigma = std::log(3.5) / (2 * nine_tenths);
  EXPECT_NEAR(2 * radius_below(*radii, 0.5, Basis::volume), median, 1e-5);
  EXPECT_NEAR(2 * radius_below(*radii, 0.9, Basis::volume), median * std::exp(nine_tenths * sigma), 1e-5);
  const std::string said = explain(build(scene));
  for (const double share : {0.1, 0.5, 0.9}) {
    const double given = share < 0.5 ? 1 : share > 0.5 ? 3.5 : 2;
    const double z = share < 0.5 ? -nine_tenths : share > 0.5 ? nine_tenths : 0;
    const double fitted = median * std::exp(sigma * z);
    const std::string words =
        fmt::format("d{:.0f} {:.4g} ({:+.1f} %)", 100 * share, fitted, 100 * (fitted / given - 1));
    EXPECT_NE(said.find(words), std::string::npos) << words << "\n" << said;
  }
  EXPECT_NE(said.find("by volume, against what was given"), std::string::npos) << said;
}

TEST(Lognormal, OfMeanAndDeviationHasThem) {
  for (const Basis basis : {Basis::number, Basis::volume}) {
    const auto sizes = make_lognormal_of_mean(3, 0.8, basis, 0, infinity);
    const int k = basis == Basis::number ? 0 : 3;
    const double mean = sizes->moment(k + 1) / sizes->moment(k);
    EXPECT_NEAR(mean, 3, 1e-13);
    EXPECT_NEAR(sizes->moment(k + 2) / sizes->moment(k) - mean * mean, 0.64, 1e-12);
  }
  // Taken for a median, a mean of 3 with a deviation of 3 would make spheres sqrt(2) times as large.
  EXPECT_NEAR(make_lognormal_of_mean(3, 3, Basis::number, 0, infinity)->quantile(0.5), 3 / std::sqrt(2),
              1e-14);
}

/// They have the same shares, by number, up to every size.
void expect_same(const SizeDistribution& a, const SizeDistribution& b) {
  EXPECT_NEAR(a.min(), b.min(), 1e-15 * b.min());
  EXPECT_NEAR(a.max(), b.max(), 1e-15 * b.max());
  for (int k = 1; k < 50; ++k) {
    const double r = b.quantile(k / 50.0);
    EXPECT_NEAR(a.cumulative(r), b.cumulative(r), 1e-12) << k;
  }
}

TEST(Sieve, RetainedIsPassingInWhateverOrderAndScale) {
  const auto passing = diameters_of("\"sieve\", sizes = [0.5, 1, 2, 4], passing = [0, 28, 74, 100]");
  for (const char* const retained :
       {"sizes = [4, 2, 1, 0.5], retained = [0, 26, 46, 28]",
        "sizes = [0.5, 1, 2, 4], retained = [28, 46, 26, 0]",
        "sizes = [1, 4, 0.5, 2], retained = [230, 0, 140, 130]"})  // grams of 500
    expect_same(*diameters_of(std::string("\"sieve\", ") + retained), *passing);
}

TEST(Sieve, APanReachesToWhereItIsSaidOrToHalfOfTheFinestSieve) {
  const auto half = diameters_of("\"sieve\", sizes = [0.25, 0.5, 1, 2], passing = [0, 10, 60, 100]");
  const auto said = diameters_of("\"sieve\", sizes = [0.1, 0.5, 1, 2], passing = [0, 10, 60, 100]");
  for (const char* const with_pan : {"sizes = [2, 1, 0.5, 0], retained = [0, 40, 50, 10]",
                                     "sizes = [2, 1, 0.5], retained = [0, 40, 50, 10]",
                                     "sizes = [0, 0.5, 1, 2], passing = [0, 10, 60, 100]"}) {
    expect_same(*diameters_of(std::string("\"sieve\", ") + with_pan), *half);
    expect_same(*diameters_of(std::string("\"sieve\", pan = 0.1, ") + with_pan), *said);
    const std::string assumed = explain(
        build(scene_of(std::string("count = 5\nradius = { distribution = \"sieve\", ") + with_pan + " }")));
    EXPECT_NE(assumed.find("the 10 % in the pan are taken to be 0.25 to 0.5 m"), std::string::npos)
        << assumed;
  }
}

TEST(Sieve, OfAFileMayBeWhatIsRetainedWithThePanByItsName) {
  const testing::Folder folder;
  const auto of_file = [&](const std::string& name, const std::string& text) {
    folder.write(name, text);
    return radii_of(
        parse_scene(testing::with_spheres("radius = { distribution = \"sieve\", file = \"" + name + "\" }"),
                    folder / "s.toml"));
  };
  const auto inline_one = diameters_of("\"sieve\", sizes = [2, 1, 0.5, 0], retained = [0, 40, 50, 10]");
  expect_same(*of_file("a.csv", "size, retained\n2, 0\n1, 40\n0.5, 50\nPan, 10\n"), *inline_one);
  expect_same(*of_file("b.csv", "retained;size (m)\n0;2\n40;1\n50;0.5\n10;0\n"), *inline_one);
  expect_same(*of_file("c.csv", "size, passing\n2, 100\n1, 60\n0.5, 10\npan, 0\n"), *inline_one);
}

TEST(Histogram, HasWhatIsInEachBinByNumberOrByMass) {
  const auto counts = diameters_of("\"histogram\", edges = [0, 1, 2, 4], counts = [0, 30, 10]");
  EXPECT_NEAR(counts->cumulative(2), 0.75, 1e-15);
  EXPECT_NEAR(counts->cumulative(1.5), 0.375, 1e-15);
  const auto masses = diameters_of("\"histogram\", edges = [1, 2, 4], masses = [30, 10]");
  EXPECT_NEAR(masses->moment_above(3, 2) / masses->moment(3), 0.25, 1e-13);
  EXPECT_NEAR(masses->moment_above(3, 3) / masses->moment(3), 0.125, 1e-13);
}

TEST(Classes, ByMassAreDividedByTheirDensities) {
  // 30 g of steel and 70 g of glass: volumes 30 / 7.85 and 70 / 2.5, over the cubes 8 and 27.
  const auto sizes = diameters_of(
      "\"classes\", values = [2, 3], shares = [30, 70], basis = \"mass\", material_densities = [7850, 2500]");
  const double steel = 30 / 7850.0 / 8, glass = 70 / 2500.0 / 27;
  EXPECT_NEAR(sizes->cumulative(2), steel / (steel + glass), 1e-15);
  const auto of_one = diameters_of("\"classes\", values = [2, 3], shares = [30, 70], basis = \"mass\"");
  expect_same(*of_one, *diameters_of("\"classes\", values = [2, 3], shares = [30, 70], basis = \"volume\""));
}

// By number 30 g / (7.85 · 2³) and 70 g / (2.5 · 3³) of each 100 g; 1 kg of them has ten times as many.
TEST(Classes, OfSeveralMaterialsAreCountedByTheirMass) {
  const std::string sizes =
      "diameter = { distribution = \"classes\", values = [2, 3], shares = [30, 70], basis = \"mass\", "
      "material_densities = [7850, 2500] }\n";
  const auto count_of = [&](const std::string& more) {
    return build(parse_scene(
        "unit = \"mm\"\n[container]\nkind = \"periodic\"\n[spheres]\nmass = \"1 kg\"\n" + more + sizes,
        "s.toml"));
  };
  const double per_gram = 6 / std::numbers::pi * 1000 * (0.3 / 7.85 / 8 + 0.7 / 2.5 / 27);
  EXPECT_NEAR(static_cast<double>(*count_of("").scene.target.count), 1000 * per_gram, 2);
  EXPECT_NEAR(*count_of("").scene.material_density, 100 / (30 / 7850.0 + 70 / 2500.0), 1e-9);
  EXPECT_NO_THROW(parse_scene(scene_as_toml(count_of("").scene), "s.toml"));
  EXPECT_THROW(count_of("material_density = 2500\n"), Error);
}

// Whatever stage draws them: every class has as many spheres as its share of the mass asks for, to one.
TEST(Classes, ByMassAreMetWithinOneSphere) {
  for (const char* const container :
       {"kind = \"periodic\"", "kind = \"cylinder\"\nradius = 12\nheight = 30"}) {
    const Scene scene = parse_scene(
        fmt::format(
            "[container]\n{}\n[spheres]\ncount = 500\ndiameter = {{ distribution = \"classes\", "
            "values = [2, 3, 2.5], shares = [30, 60, 10], basis = \"mass\", material_densities = [7850, "
            "2500, 1000], names = [\"steel\", \"glass\", \"wax\"] }}\n",
            container),
        "s.toml");
    const Packing packing = run(build(scene));
    ASSERT_EQ(packing.spheres.size(), 500U);
    std::map<double, double> counts;
    for (const double r : packing.spheres.r) ++counts[2 * r];
    const std::map<double, double> density = {{2, 7850}, {2.5, 1000}, {3, 2500}},
                                   share = {{2, 0.3}, {2.5, 0.1}, {3, 0.6}};
    double numbers = 0, mass = 0, heaviest = 0;
    for (const auto& [d, of_mass] : share) numbers += of_mass / density.at(d) / (d * d * d);
    for (const auto& [d, n] : counts) {
      const double of_number = share.at(d) / density.at(d) / (d * d * d) / numbers;
      EXPECT_NEAR(n, 500 * of_number, 1) << d;
      mass += n * density.at(d) * d * d * d;
      heaviest = std::max(heaviest, density.at(d) * d * d * d);
    }
    for (const auto& [d, n] : counts)
      EXPECT_NEAR(n * density.at(d) * d * d * d, share.at(d) * mass, heaviest) << d;
    const std::string said = explain(build(scene));
    EXPECT_NE(said.find("% by mass"), std::string::npos) << said;
    EXPECT_NE(said.find("steel"), std::string::npos) << said;
  }
}

TEST(Explain, SaysABasisThatMattersAndIsNotSaid) {
  const auto said = [](const std::string& keys) {
    return explain(
        build(scene_of("count = 9\ndiameter = { distribution = \"lognormal\", median = 1, " + keys + " }")));
  };
  // By volume half lies below e^(3 sigma²).
  EXPECT_NE(said("sigma = 0.5").find("half of their volume below 2.117"), std::string::npos)
      << said("sigma = 0.5");
  EXPECT_EQ(said("sigma = 0.1").find("no basis"), std::string::npos);
  EXPECT_EQ(said("sigma = 0.5, basis = \"number\"").find("no basis"), std::string::npos);
}

TEST(Explain, ShowsSharesByNumberAndVolumeAndD50ByVolume) {
  const std::string said =
      explain(build(scene_of("count = 9\nradius = { distribution = \"classes\", values = [1, 2], shares = "
                             "[1, 1], basis = \"volume\" }")));
  EXPECT_NE(said.find("88.89             50"), std::string::npos) << said;  // 8 : 1 by number
  EXPECT_NE(said.find("D10 2, D50 4, D90 4 m by volume; 2, 2, 4 by number"), std::string::npos) << said;
}

}  // namespace size_wishes_test
}  // namespace bernal
