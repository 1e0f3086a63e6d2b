#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace bernal::cad {

/// Without blanks and ends of lines around it.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// The finite number that a text is, and nothing else, but for a sign + and blanks around it: what is too
/// small for a double is 0. Nothing where it is none, or longer than a number needs.
std::optional<double> finite_number(std::string_view text);

/// ".stl" of "Part.STL".
std::string extension_of(const std::filesystem::path& file);

/// Why a file is no mesh, and what to do about it, told by its name and its first bytes: native CAD formats,
/// archives, web pages, pointers of git-lfs, formats that nobody has tested. Empty where a reader should try.
std::string known_not_to_be_a_mesh(const std::filesystem::path& file);

}  // namespace bernal::cad
