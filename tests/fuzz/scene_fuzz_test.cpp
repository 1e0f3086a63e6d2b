#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"
#include "support/scenes.hpp"

namespace bernal {
namespace scene_fuzz_test {

constexpr std::array<std::string_view, 22> tokens = {
    "nan",        "-inf",   "1e308",   "5e-324",  "-0.0",        "9223372036854775807",
    "-1",         "[[[[[[", "{ a = {", "\"\"\"",  "''",          "\\u0000",
    "\0",         "\xff",   "= =",     "[stage]", "[[stage]]\n", "1979-05-27",
    "0x7fffffff", "\r",     "#",       "."};

/// Whatever the text: a scene that can be written and read again, or one line that says what is wrong.
bool is_a_scene(const std::string& text) {
  try {
    const Scene scene = parse_scene(text, "fuzz.toml");
    const std::string written = scene_as_toml(scene);
    EXPECT_EQ(scene_as_toml(parse_scene(written, "fuzz.toml")), written) << text;
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_EQ(std::strncmp(error.what(), "fuzz.toml", 9), 0) << error.what();
    EXPECT_EQ(std::strpbrk(error.what(), "\n\r"), nullptr) << error.what();
    return false;
  }
}

TEST(FuzzScene, EveryMutationIsASceneOrAnError) {
  std::vector<std::string> scenes;
  for (const auto& file : testing::example_scenes()) scenes.push_back(testing::text_of(file));
  ASSERT_FALSE(scenes.empty());
  const std::size_t mutations = testing::fuzz_inputs(10'000);
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < mutations; ++i) {
    Random random(1, stream(Stream::test, i));
    accepted += is_a_scene(testing::mutated(scenes[i % scenes.size()], tokens, random, scenes));
  }
  // Both paths are taken: comments and values may change, structure may not.
  EXPECT_GT(accepted, mutations / 50);
  EXPECT_LT(accepted, mutations - mutations / 5);
}

TEST(FuzzScene, EveryPrefixIsASceneOrAnError) {
  for (const auto& file : testing::example_scenes()) {
    const std::string text = testing::text_of(file);
    for (std::size_t n = 0; n <= text.size(); ++n) is_a_scene(text.substr(0, n));
    EXPECT_TRUE(is_a_scene(text));
  }
}

TEST(FuzzScene, DeepNestingIsAnError) {
  EXPECT_FALSE(is_a_scene("a = " + std::string(100'000, '[')));
  std::string tables;
  for (int i = 0; i < 10'000; ++i) tables += "a.";
  EXPECT_FALSE(is_a_scene("[" + tables + "a]"));
  EXPECT_FALSE(is_a_scene(tables + "a = 1"));
  std::string inline_tables;
  for (int i = 0; i < 10'000; ++i) inline_tables += "a = {";
  EXPECT_FALSE(is_a_scene(inline_tables));
}

}  // namespace scene_fuzz_test
}  // namespace bernal
