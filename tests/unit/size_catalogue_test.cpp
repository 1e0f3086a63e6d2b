#include <gtest/gtest.h>

#include <map>
#include <string>

#include <fmt/format.h>

#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"
#include "scene/scene_entries.hpp"

namespace bernal {
namespace size_catalogue_test {

/// How a user states each of them, in lengths between 1 and 3.
const std::map<std::string, std::string, std::less<>> stated = {
    {"constant", "value = 2"},
    {"classes", "values = [3, 1], shares = [1, 2]"},
    {"uniform", "min = 1, max = 3"},
    {"normal", "mean = 2, sd = 1, min = 1, max = 3"},
    {"lognormal", "median = 1.5, sigma = 1, min = 1, max = 3"},
    {"table", "x = [3, 1, 2], density = [0, 4, 5], basis = \"volume\""},
    {"sieve", "sizes = [3, 1, 2], passing = [100, 0, 20]"},
    {"rosin_rammler", "d63 = 2, n = 1, min = 1, max = 3"},
    {"fuller", "max = 3, min = 1"},
    {"mixture", "of = [1.5, { distribution = \"uniform\", min = 1, max = 3 }], shares = [1, 2]"},
    {"percentiles", "d10 = 1.5, d50 = 2, d90 = 2.5, min = 1, max = 3"},
    {"histogram", "edges = [1, 2, 3], counts = [3, 1]"},
    {"list", "values = [3, 1, 1.5]"}};

Scene scene_of(std::string_view key, std::string_view distribution, std::string_view keys) {
  return parse_scene(fmt::format("container = {{ kind = \"sphere\", radius = 9 }}\n[spheres]\n"
                                 "{} = {{ distribution = \"{}\", {} }}\n",
                                 key, distribution, keys),
                     "s.toml");
}

TEST(SizeCatalogue, MakesWhatTheSchemaNames) {
  const auto& entries = schema::size_entries();
  EXPECT_EQ(entries.size(), std::variant_size_v<SceneSizes::variant>);
  for (const schema::Entry& entry : entries) {
    ASSERT_TRUE(stated.contains(entry.name)) << entry.name;
    const auto sizes = radii_of(scene_of("diameter", entry.name, stated.find(entry.name)->second));
    EXPECT_GE(sizes->min(), 0.5);
    EXPECT_LE(sizes->max(), 1.5);
  }
}

TEST(SizeCatalogue, RadiiAreTwiceWhatDiametersOfTheSameLengthsGive) {
  for (const auto& [name, keys] : stated) {
    if (name == "rosin_rammler" || name == "percentiles") continue;  // d63, d10: diameters by their names
    const auto radii = radii_of(scene_of("radius", name, keys));
    const auto halves = radii_of(scene_of("diameter", name, keys));
    for (const double p : {0.0, 0.01, 0.3, 0.5, 0.99, 1.0})
      EXPECT_NEAR(radii->quantile(p), 2 * halves->quantile(p), 1e-14) << name << " " << p;
  }
}

TEST(SizeCatalogue, RefusesWhatOnlyTheNumbersTogetherShowAtItsLine) {
  const std::map<std::string, std::pair<std::string, std::string>> bad = {
      {"normal", {"mean = 1, sd = 0.3", "cut it off with \"min\""}},
      {"rosin_rammler", {"d63 = 1, n = 5, min = 4", "lies above \"min\""}},
      {"lognormal", {"median = 1, sigma = 0.01, min = 1e6", "no radius"}},
      {"percentiles", {"d10 = 1, d50 = 2, law = \"normal\"", "cut it off with \"min\""}}};
  for (const auto& [name, what] : bad) {
    try {
      radii_of(scene_of("diameter", name, what.first));
      ADD_FAILURE() << name << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      EXPECT_TRUE(std::string(error.what()).starts_with("s.toml:3: ")) << error.what();
      EXPECT_NE(std::string(error.what()).find(what.second), std::string::npos) << error.what();
    }
  }
}

}  // namespace size_catalogue_test
}  // namespace bernal
