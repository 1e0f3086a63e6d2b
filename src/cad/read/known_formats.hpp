#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace bernal::cad {

/// Without leading and trailing white space.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Parses a text that is a finite number and nothing else except a sign + and blanks around it; underflow
/// gives 0. Absent otherwise, or if it is longer than a number needs.
std::optional<double> finite_number(std::string_view text);

/// ".stl" of "Part.STL".
std::string extension_of(const std::filesystem::path& file);

/// Why a file is not a mesh, and the remedy, by its name and its first bytes: native CAD formats, archives,
/// web pages, git-lfs pointers, untested formats. Empty if a reader should try.
std::string why_no_mesh(const std::filesystem::path& file);

}  // namespace bernal::cad
