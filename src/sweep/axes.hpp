#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <toml++/toml.h>

#include "sweep/key_path.hpp"

namespace bernal::sweep {

/// One value of one swept key.
struct Setting {
  std::size_t key = 0;  ///< its place among all swept keys
  std::string text;     ///< as a table shows it: strings without quotation marks, the rest as TOML
  Assignment assignment;
};

/// Values that are taken together.
using Choice = std::vector<Setting>;

/// Of these exactly one is taken.
using Alternatives = std::vector<Choice>;

/// What a sweep says of its cells.
struct Axes {
  std::vector<std::string> keys;
  std::vector<Alternatives> axes;  ///< the last of them is the fastest

  /// How many cells there are. Throws Error{bad_scene} for more than a million.
  std::size_t size(const std::filesystem::path& file) const;
  /// Of a cell, counted from 0: a choice of each axis.
  std::vector<Choice*> choices(std::size_t cell);
};

/// [[case]], [grid] and `repeats` of a sweep, which is taken apart. `seed`: that of its scene, from which
/// repeats go on. Throws Error{bad_scene} with file and line.
Axes read_axes(toml::table& sweep, const std::filesystem::path& file, std::int64_t seed);

/// A node as a cell of a table has it.
std::string shown(const toml::node& node);

}  // namespace bernal::sweep
