#pragma once
#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "bernal/core/unit.hpp"
#include "scene/entry.hpp"

namespace bernal {

/// Two columns of numbers.
struct TwoColumns {
  std::array<const schema::Key*, 2> keys;  ///< say what they are called and what each number must be
  Unit unit;                               ///< in which lengths are wanted
  std::size_t most;                        ///< pairs
  std::string_view if_more;                ///< what to do about more: "sum them up in fewer"
};

/// Those of a text file: one pair a line, with a comma, semicolon or blank space between. Empty lines and
/// what follows a # are passed over; a line "# unit: m" is heeded. One line of headings may stand before the
/// first pair: where it names the columns the other way round, they are, and "size (m)" says a unit too.
/// Throws Error{bad_scene} with file and line, or without a location if the file cannot be read at all.
std::array<std::vector<double>, 2> read_columns(const std::filesystem::path& file, const TwoColumns& wanted);

}  // namespace bernal
