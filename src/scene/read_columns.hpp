#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "bernal/core/unit.hpp"
#include "scene/entry.hpp"

namespace bernal {

/// One or two columns of numbers.
struct WantedColumns {
  std::vector<const schema::Key*> keys;  ///< say what they are called and what each number must be
  Unit unit;                             ///< in which lengths are wanted
  std::size_t most;                      ///< lines of numbers
  std::string_view if_more;              ///< what to do about more: "sum them up in fewer"
  const schema::Key* other = nullptr;    ///< what the second column is where its heading says so
};

/// Those of a text file: one number a line, or one pair with a comma, semicolon or blank space between. Empty
/// lines and what follows a # are passed over; a line "# unit: m" is heeded. One line of headings may stand
/// before the first number: where it names two columns the other way round, they are, and "size (m)" says a
/// unit too. "pan" stands for the length 0 where that is one. One column may also be an array of NumPy's
/// (.npy) of one dimension, in the wanted unit. Throws Error{bad_scene} with file and line, or without a
/// location if the file cannot be read at all. `wanted` then names the columns that are there.
std::vector<std::vector<double>> read_columns(const std::filesystem::path& file, WantedColumns& wanted);

}  // namespace bernal
