#include "bernal/map/map.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/map/check_prediction.hpp"
#include "bernal/predict/mixtures.hpp"
#include "map/contours.hpp"
#include "report/plot.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace map_test {

using testing::Folder;
using testing::text_of;

/// The columns of a CSV whose fields are numbers, words or nothing.
std::map<std::string, std::vector<std::string>> columns_of(const std::filesystem::path& file) {
  std::istringstream in(text_of(file));
  std::string line, field;
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> columns;
  while (std::getline(in, line)) {
    std::istringstream fields(line + ",");
    for (std::size_t k = 0; std::getline(fields, field, ','); ++k) {
      if (columns.size() <= k && names.size() <= k)
        names.push_back(field);
      else
        columns[names.at(k)].push_back(field);
    }
    for (const std::string& name : names) columns[name];
  }
  return columns;
}

double number(const std::string& field) { return std::stod(field); }

TEST(Mixtures, ManySharesAtOnceAreTheSameAsOneByOne) {
  const std::vector<double> shares = {0, 1e-6, 0.1, 0.5, 0.83, 1 - 1e-6, 1};
  for (const TwoPopulations& p :
       {TwoPopulations{0, 0, 1}, TwoPopulations{0, 0, 5}, TwoPopulations{0.3, 0, 0.1},
        TwoPopulations{0, 0.6, 10}, TwoPopulations{0.5, 0.5, 1}, TwoPopulations{1, 0.2, 40}}) {
    const std::vector<Prediction> all = predict_shares(p, shares, 2000);
    ASSERT_EQ(all.size(), shares.size());
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const Prediction one =
          predict_packing_fraction(*make_two_populations({p.sigma_a, p.sigma_b, p.ratio, shares[i]}), 2000);
      // Both tables are right to 2e-12, see chord_table.hpp; placing rods loses a few digits at kinks.
      EXPECT_NEAR(all[i].phi, one.phi, 1e-9)
          << p.sigma_a << ' ' << p.sigma_b << ' ' << p.ratio << ' ' << shares[i];
      EXPECT_NEAR(all[i].error, one.error, 1e-8);
      EXPECT_EQ(all[i].rods, 2000);
    }
  }
}

TEST(Mixtures, AreWhatTheTableOfThePaperSays) {
  // Farr 2013, table 2: half the volume each, mean diameters 1 : 2.
  const auto phi = [](double a, double b) {
    return predict_packing_fraction(*make_two_populations({a, b, 2, 0.5}), 16000).phi;
  };
  EXPECT_NEAR(phi(0, 0), 0.676, 5e-4);
  EXPECT_NEAR(phi(0.3, 0), 0.702, 5e-4);
  EXPECT_NEAR(phi(0, 0.3), 0.674, 5e-4);
  EXPECT_NEAR(phi(0.3, 0.3), 0.699, 5e-4);
}

TEST(Mixtures, RefuseWhatIsOutOfRange) {
  for (const TwoPopulations& p : {TwoPopulations{-1, 0, 1, 0.5}, TwoPopulations{0, NAN, 1, 0.5},
                                  TwoPopulations{0, 0, 0, 0.5}, TwoPopulations{0, 0, 1, 1.5}})
    EXPECT_THROW(make_two_populations(p), Error);
  EXPECT_THROW(predict_shares({}, std::vector{0.5, -0.1}, 100), Error);
  EXPECT_THROW(predict_shares({}, std::vector{0.5}, 1), Error);
}

TEST(Plot, LogarithmicAxes) {
  const Plot plot({100, 0, 200, 300}, {1, 100, "", Scale::logarithmic}, {0.5, 8, "", Scale::logarithmic});
  EXPECT_NEAR(plot.x(10), 150, 1e-12);
  EXPECT_NEAR(plot.y(2), 150, 1e-12);
  EXPECT_NEAR(plot.y_at(plot.y(3)), 3, 1e-12);
  EXPECT_EQ(Ticks({1, 10, "", Scale::logarithmic}).values(), (std::vector<double>{1, 2, 5, 10}));
  EXPECT_EQ(Ticks({0.1, 1e5, "", Scale::logarithmic}).values().size(), 7u);
  // An axis that is none has none, and comes to an end.
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] :
       {std::pair(0.0, 10.0), std::pair(-1.0, 10.0), std::pair(1.0, inf), std::pair(inf, inf),
        std::pair(std::nan(""), 10.0), std::pair(1.0, std::nan(""))})
    EXPECT_TRUE(Ticks({from, to, "", Scale::logarithmic}).values().empty()) << from << " " << to;
  EXPECT_LT(Ticks({1e-320, 1.7e308, "", Scale::logarithmic}).values().size(), 1000u);
}

TEST(Contours, OfAPlaneAreStraight) {
  // The value is 10 x, so the line of level 5 k stands at x = k / 2, the bold one of 5 is named.
  Plot plot({0, 0, 100, 100}, {0, 1}, {0, 1});
  drawing::add_contours(plot, {{0, 0.3, 1}, {0, 1}, {0, 3, 10, 0, 3, 10}}, 1);
  const std::string svg = std::move(plot).finish();
  EXPECT_NE(svg.find("contour bold\" d=\"M50.0 100.0L50.0 0.0"), std::string::npos);
  EXPECT_NE(svg.find(">5.00<"), std::string::npos);
  const std::regex line("class=\"contour");
  EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), line), std::sregex_iterator()), 10);
}

TEST(Contours, OfASaddleDoNotCross) {
  // xy at the middle of a cell is 0; corners of the same sign are joined through a level below the mean.
  Plot plot({0, 0, 100, 100}, {-1, 1}, {-1, 1});
  drawing::add_contours(plot, {{-1, 1}, {-1, 1}, {1, -1, -1, 1}}, 0.8);
  const std::string svg = std::move(plot).finish();
  // At level 0.8 the corners (-1,-1) and (1,1), at the lower left and the upper right, are cut off.
  EXPECT_NE(svg.find("M0.0 90.0L10.0 100.0"), std::string::npos);
  EXPECT_EQ(svg.find("M10.0 100.0L100.0 10.0"), std::string::npos);
}

TEST(Map, HasEveryPointAndKnowsTheDensest) {
  const Folder folder;
  std::vector<double> fractions;
  MapOptions options{.least_ratio = 1, .most_ratio = 5, .points = 41, .rods = 1000};
  options.monitor.on_progress = [&](const Progress& p) { fractions.push_back(p.fraction); };
  const WrittenMap map = write_map(options, folder.path());
  ASSERT_EQ(map.files.size(), 2u);
  const auto csv = columns_of(folder.path() / "map.csv");
  ASSERT_EQ(csv.at("phi").size(), 41u * 41u);
  EXPECT_FALSE(fractions.empty());
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  double most = 0;
  for (const std::string& phi : csv.at("phi")) most = std::max(most, number(phi));
  EXPECT_NEAR(most, map.phi, 1e-6);
  // 1 : 5 with a fifth small: 0.787 (tests of predict_packing_fraction); the densest is at the widest ratio.
  EXPECT_EQ(map.ratio, 5);
  EXPECT_NEAR(map.share, 0.8, 0.03);
  EXPECT_NEAR(map.phi, 0.787, 0.003);
  options.monitor.cancelled = [] { return true; };
  EXPECT_TRUE(write_map(options, folder.path() / "none").files.empty());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "none"));
  options.points = 1;
  EXPECT_THROW(write_map(options, folder.path()), Error);
}

TEST(Map, ReplacesNothingButAMap) {
  const Folder folder;
  const MapOptions options{.points = 2, .rods = 100};
  EXPECT_EQ(write_map(options, folder.path()).files.size(), 2u);
  EXPECT_EQ(write_map(options, folder.path()).files.size(), 2u);
  std::ofstream(folder.path() / "map.csv") << "mine\n";
  EXPECT_THROW(write_map(options, folder.path()), Error);
  std::ifstream left(folder.path() / "map.csv");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(left), {}), "mine\n");
}

TEST(PredictionCheck, PacksTheSizesThatWerePredicted) {
  const double sigma = 0.3;
  const Lognormal wide{.median = std::exp(-0.5 * sigma * sigma), .sigma = sigma, .basis = Basis::volume};
  const Mixture mix{.of = {wide, Constant{2}}, .shares = {1, 1}, .basis = Basis::volume};
  const Scene scene = scene_to_check(mix, false, {.spheres = 2000});
  EXPECT_NEAR(predict_packing_fraction(*radii_of(scene)).phi,
              predict_packing_fraction(*make_two_populations({sigma, 0, 2, 0.5})).phi, 1e-12);
  const PredictionCheck check = check_prediction(scene, {});
  EXPECT_EQ(check.spheres, 2000u);
  EXPECT_TRUE(check.certified);
  EXPECT_EQ(check.outcome, Outcome::converged);
  // The model is worth 0.01; 2,000 spheres by quantiles have nearly its sizes.
  EXPECT_NEAR(check.phi, check.predicted, 0.01);
  EXPECT_NEAR(check.predicted, 0.7024, 1e-3);
  EXPECT_GT(check.coordination, 4);
  EXPECT_LT(check.coordination, 6.2);
}

TEST(PredictionCheck, WideDistributionsNeedMoreSpheres) {
  const auto needed = [](double sigma) {
    return spheres_for(*make_two_populations({.sigma_a = sigma, .share = 0}));
  };
  EXPECT_EQ(needed(0), 10'000);
  EXPECT_EQ(needed(0.5), 10'000);
  EXPECT_GT(needed(0.9), 10'000);
  EXPECT_EQ(needed(2), 200'000);
}

}  // namespace map_test
}  // namespace bernal
