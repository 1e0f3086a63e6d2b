#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "scene/entry.hpp"

namespace bernal {

/// Two columns of numbers from a text file: one pair a line, with a comma, semicolon or blank space between.
/// Empty lines, what follows a #, and one line of headings before the first pair are passed over. The keys
/// say what the columns are called and what each number must be. Throws Error{bad_scene} with file and line,
/// or without a location if the file cannot be read at all.
std::array<std::vector<double>, 2> read_columns(const std::filesystem::path& file,
                                                const std::array<const schema::Key*, 2>& keys);

}  // namespace bernal
