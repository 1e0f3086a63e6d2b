#pragma once
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/command.hpp"

namespace bernal::testing {

/// Exit code 2, nothing on standard output, and a last line on standard error that has all of the words.
inline void expect_refused(const Ended& ended, const std::vector<std::string>& words) {
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(ended.out, "");
  ASSERT_TRUE(ended.err.ends_with('\n'));
  const std::size_t start = ended.err.find_last_of('\n', ended.err.size() - 2) + 1;
  const std::string line = ended.err.substr(start);
  EXPECT_TRUE(line.starts_with("bernal: ")) << ended.err;
  for (const std::string& word : words)
    EXPECT_NE(line.find(word), std::string::npos) << word << "\nis not in: " << line;
}

/// The same, and that line is the only one.
inline void expect_refused_in_one_line(const Ended& ended, const std::vector<std::string>& words) {
  expect_refused(ended, words);
  EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
}

/// 300 equal spheres in a box: done in a blink.
inline constexpr const char* small_scene = R"(unit = "mm"
[container]
kind = "box"
size = [10, 10, 10]
[spheres]
count = 300
diameter = 1
)";

inline nlohmann::json report_of(const std::filesystem::path& folder) {
  return nlohmann::json::parse(text_of(folder / "report.json"));
}

}  // namespace bernal::testing
