#pragma once
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "files/staged_folder.hpp"
#include "support/folder.hpp"

// What the tests of folders that runs write into share.
namespace bernal::testing {

/// Texts by the names of their files.
using Files = std::map<std::string, std::string>;

inline Files files_in(const std::filesystem::path& folder) {
  Files files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file()) files[entry.path().filename()] = text_of(entry.path());
  return files;
}

inline std::size_t entries_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

inline std::vector<std::string> names_of(const Files& files) {
  std::vector<std::string> names;
  for (const auto& [name, text] : files) names.push_back(name);
  return names;
}

inline void publish(const std::filesystem::path& folder, const Files& files, const Files& replaced) {
  StagedFolder staged(folder);
  for (const auto& [name, text] : files) staged.write(name, text);
  staged.publish(names_of(replaced));
}

}  // namespace bernal::testing
