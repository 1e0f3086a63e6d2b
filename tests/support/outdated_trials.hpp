#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include "bernal/version.hpp"
#include "cost/rounds.hpp"
#include "support/folder.hpp"

namespace bernal::testing {

/// Lets the trials of that seed, on one thread, whose lines in a trials.csv hold a text be of other packings,
/// sealed as if a bernal of these had run them. Returns how many there are.
inline int let_trials_be_of(int packings, const std::filesystem::path& file, int seed,
                            std::string_view text = "") {
  const std::string own = fmt::format(",{},1,{},", seed, packings_number());
  std::istringstream lines(text_of(file));
  std::string whole, line;
  int changed = 0;
  while (std::getline(lines, line)) {
    const std::size_t at = line.find(own);
    if (at != line.npos && line.find(text) != line.npos) {
      line.replace(at, own.size(), fmt::format(",{},1,{},", seed, packings));
      line.resize(line.rfind(',') + 1);
      line += cost::hash_of_text(line);
      ++changed;
    }
    whole += line + '\n';
  }
  std::ofstream(file) << whole;
  return changed;
}

}  // namespace bernal::testing
