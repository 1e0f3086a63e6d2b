// What measures bernal's own work: that the tables hold what was run. Times are not asserted.
#include "bernal/cost/bench.hpp"

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/run/run.hpp"
#include "bernal/soft/relax.hpp"
#include "cost/bench_drawing.hpp"
#include "cost/bench_tables.hpp"
#include "cost/methods_picture.hpp"
#include "cost/trial.hpp"

namespace bernal {
namespace bench_test {

/// The lines of a CSV, each by the names of its columns; texts may stand in quotes.
std::vector<std::map<std::string, std::string>> lines_of(const std::string& csv) {
  std::vector<std::map<std::string, std::string>> lines;
  std::vector<std::string> names;
  std::istringstream in(csv);
  for (std::string text; std::getline(in, text);) {
    std::vector<std::string> cells(1);
    bool inside = false;
    for (const char c : text) {
      if (c == '"')
        inside = !inside;
      else if (c == ',' && !inside)
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), names.size()) << text;
    lines.emplace_back();
    for (std::size_t k = 0; k < std::min(cells.size(), names.size()); ++k) lines.back()[names[k]] = cells[k];
  }
  return lines;
}

const BenchFile& file_of(const std::vector<BenchFile>& files, std::string_view name) {
  for (const BenchFile& file : files)
    if (file.name == name) return file;
  throw std::runtime_error("no file " + std::string(name));
}

double number(const std::string& text) { return std::stod(text); }

TEST(Bench, EverySceneIsALineWithWorkThatWasDone) {
  std::vector<std::string> names;
  for (const Bench& bench : all_benches())
    if (!bench.has_own_table()) names.emplace_back(bench.name);
  ASSERT_GE(names.size(), 7u);
  const std::vector<BenchFile> files = run_benches(names, {.spheres = 200});
  ASSERT_EQ(files.size(), 2u);
  const auto lines = lines_of(file_of(files, "bench.csv").text);
  ASSERT_EQ(lines.size(), names.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    SCOPED_TRACE(names[k]);
    EXPECT_EQ(lines[k].at("bench"), names[k]);
    EXPECT_GT(number(lines[k].at("work")), 0);
    EXPECT_GT(number(lines[k].at("seconds")), 0);
    EXPECT_NEAR(number(lines[k].at("ns_each")),
                1e9 * number(lines[k].at("seconds")) / number(lines[k].at("work")),
                1 + 1e-3 * number(lines[k].at("ns_each")));
    EXPECT_NE(file_of(files, "bench.md").text.find("| " + names[k] + " |"), std::string::npos);
  }
}

TEST(Bench, RunsWhatIsNamedAndRefusesWhatIsNot) {
  const auto lines = lines_of(file_of(run_benches(std::vector<std::string>{"predict"}), "bench.csv").text);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].at("bench"), "predict");
  EXPECT_NEAR(number(lines[0].at("work")), 16000, 0.5);
  try {
    run_benches(std::vector<std::string>{"relax", "metods"});
    FAIL() << "took an unknown name";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("did you mean \"methods\""), std::string::npos) << error.what();
  }
}

TEST(Bench, WritesNothingOnceItIsStopped) {
  for (const Bench& bench : all_benches()) {
    const std::vector<std::string> name = {std::string(bench.name)};
    EXPECT_TRUE(run_benches(name, {.spheres = 200, .monitor = {{}, [] { return true; }}}).empty())
        << bench.name;
  }
}

// More sweeps, slower growth, more refilling: what costs more time is there because it packs denser.
TEST(BenchMethods, EveryMethodHasAnUpwardLadderOfTwoSeeds) {
  const cost::SizeClass equal[] = {cost::equal_sizes()};
  const std::vector<BenchFile> files = cost::methods_of(equal, {.spheres = 100});
  std::map<std::string, std::map<double, double>> phi;  // by the value of the knob, of both seeds
  std::map<std::string, std::set<std::string>> seeds;
  for (const auto& line : lines_of(file_of(files, "methods.csv").text)) {
    const std::string method = line.at("walls") + " " + line.at("method");
    seeds[method].insert(line.at("seed"));
    ASSERT_NE(line.at("outcome"), "cut_off") << method;
    const double reached = number(line.at("packing_fraction"));
    EXPECT_LT(reached, M_PI / std::sqrt(18)) << method << ": equal spheres are never denser";
    EXPECT_EQ(line.at("walls") == "lids", !line.at("core_packing_fraction").empty()) << method;
    phi[method][number(line.at("value"))] += 0.5 * reached;
    EXPECT_NE(file_of(files, "methods_equal.svg").text.find(line.at("method")), std::string::npos);
  }
  EXPECT_EQ(phi.size(), 11u) << "with the filling by classes, which is for wide sizes, they are twelve";
  for (auto& [method, values] : phi) {
    EXPECT_GE(values.size(), 3u) << method;
    EXPECT_EQ(seeds[method], (std::set<std::string>{"1", "2"})) << method;
    const double first = values.begin()->second, last = values.rbegin()->second;
    const bool grows = method.find("growth") != std::string::npos;  // where a smaller rate is the slower
    EXPECT_GT(grows ? first : last, grows ? last : first) << method;
  }
}

/// Where the words of a picture stand, by the text of its <text> elements of a class.
std::vector<cost::Place> places_of_names(const std::string& svg) {
  std::vector<cost::Place> places;
  for (std::size_t at = svg.find("<text class=\"name"); at != svg.npos;
       at = svg.find("<text class=\"name", at + 1)) {
    const auto value = [&](const char* key) {
      return std::stod(svg.substr(svg.find(key, at) + std::string(key).size()));
    };
    const std::size_t begin = svg.find('>', at) + 1;
    const double x = value(" x=\""), y = value(" y=\"");
    places.push_back({x, y - 8, x + 6 * static_cast<double>(svg.find('<', begin) - begin), y});
  }
  return places;
}

TEST(BenchMethods, NamesInThePictureDoNotCoverEachOther) {
  cost::MethodsPicture picture{"lines that end at the same place", 0.65, {}};
  for (int k = 0; k < 7; ++k) {
    const double low = 0.5 + 0.001 * k;
    picture.lines.push_back({"a method called " + std::to_string(k),
                             k,
                             k % 2 == 1,
                             {{0.01, low, 0}, {0.1, low + 0.1, 0}, {1, low + 0.12, 0.001}}});
  }
  const std::vector<cost::Place> places = places_of_names(cost::draw(picture));
  ASSERT_EQ(places.size(), 7u);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_GT(places[i].left, 0);
    EXPECT_LT(places[i].right, 720);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(places[i].left < places[j].right && places[j].left < places[i].right &&
                   places[i].top < places[j].bottom && places[j].top < places[i].bottom)
          << i << " and " << j;
  }
}

TEST(BenchEffects, EveryPairIsThereWithItsRatio) {
  const std::vector<BenchFile> files = cost::effects({.spheres = 100});
  const auto lines = lines_of(file_of(files, "effects.csv").text);
  ASSERT_GE(lines.size(), 12u);
  std::map<std::string, double> gain, scatter;
  for (const auto& line : lines) {
    const std::string& effect = line.at("effect");
    gain[effect] = number(line.at("gain"));
    scatter[effect] = number(line.at("gain_scatter"));
    EXPECT_GT(number(line.at("seconds_with")), 0) << effect;
    EXPECT_GT(number(line.at("time_ratio")), 0) << effect;
    EXPECT_NE(line.at("with"), line.at("without")) << effect;
    EXPECT_NE(file_of(files, "effects.md").text.find("| " + effect + " |"), std::string::npos);
    EXPECT_NE(file_of(files, "effects.svg").text.find(">" + effect + "<"), std::string::npos);
  }
  EXPECT_EQ(gain.size(), lines.size()) << "no effect has two lines";
  // What no seed can turn round, at any number of spheres.
  EXPECT_GT(gain.at("refilling"), 0.05);
  EXPECT_LT(gain.at("side walls"), 0);
  EXPECT_LT(gain.at("a floor and a lid"), 0);
}

TEST(Trial, TellsTheCoreApartFromTheWalls) {
  Scene scene = cost::room_for(cost::equal_sizes(), 1000, cost::Sides::lids, 0.58);
  scene.target.packing_fraction = 0.57;
  scene.stages = {Relax{}};
  const cost::Trial trial = cost::run_trial(scene, {.threads = 1, .with_core = true});
  ASSERT_TRUE(trial.core_packing_fraction);
  EXPECT_GT(*trial.core_packing_fraction, trial.packing_fraction)
      << "the spheres beside the walls pack loosely";
  EXPECT_FALSE(cost::run_trial(scene, {.threads = 1}).core_packing_fraction);
}

}  // namespace bench_test
}  // namespace bernal
