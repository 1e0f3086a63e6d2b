#include "scene/toml_file.hpp"

#include <algorithm>
#include <cctype>
#include <system_error>

#include <fmt/format.h>

#include "bernal/core/quantity.hpp"
#include "bernal/core/text.hpp"
#include "files/file_kind.hpp"
#include "files/input_file.hpp"

namespace bernal {
namespace {

/// Of "a.b.c" the parser makes tables in tables, and comes back from them by recursion.
void require_shallow(std::string_view text, const std::string& file) {
  constexpr int most_parts = 32;
  int parts = 1, line = 1;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '.' && ++parts > most_parts)
      throw Error(ErrorCode::bad_scene,
                  fmt::format("a key has more than {} parts; no key of a scene has", most_parts),
                  {file, line});
    if (c == '"' || c == '\'') {  // is one part
      while (++k < text.size() && text[k] != c && text[k] != '\n')
        if (text[k] == '\\' && c == '"') ++k;
      if (k < text.size() && text[k] == '\n') --k;
      continue;
    }
    if (c == '#')
      while (k + 1 < text.size() && text[k + 1] != '\n') ++k;
    const bool in_key = c == '.' || c == '_' || c == '-' || c == ' ' || c == '\t' ||
                        std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (!in_key) parts = 1;
    line += c == '\n';
  }
}

/// What a line most likely means that is no TOML because of a number with a comma, or with a unit but without
/// quotes; empty where it has none.
std::string remedy_of_number(std::string_view text, std::size_t line) {
  for (; line > 1 && !text.empty(); --line)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  text = text.substr(0, text.find_first_of("\n#"));
  for (std::size_t at = text.find('='); at != std::string_view::npos; at = text.find('=', at + 1)) {
    const std::string_view rest = trimmed(text.substr(at + 1));
    std::string_view word = rest.substr(0, rest.find_first_of("]} \t"));
    if (word.ends_with(',')) word.remove_suffix(1);
    if (const auto with_point = without_decimal_comma(word))
      return fmt::format("; a decimal comma? write a point, {}", *with_point);
    const std::string_view value = trimmed(rest.substr(0, rest.find_first_of(",]}")));
    std::string complaint;
    for (const Quantity of : {Quantity::diameter, Quantity::mass, Quantity::density})
      if (number_with_unit(value, of, Unit::m, complaint))
        return fmt::format("; a number with its unit stands in quotes, \"{}\"", value);
  }
  return {};
}

}  // namespace

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t\n\r") == std::string_view::npos; }

std::string read_toml_text(const std::filesystem::path& file, std::string_view called,
                           std::streamsize largest, std::string_view beyond) {
  const auto fail = [&](const std::string& why) { throw Error(ErrorCode::bad_scene, why, {file.string()}); };
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::missing) fail(fmt::format("no such {} file", called));
  if (kind == FileKind::folder) fail(fmt::format("this is a folder, not a {} file", called));
  if (kind == FileKind::other) fail(fmt::format("this is a pipe or a device, not a {} file", called));
  InputFile in(file);
  if (!in) fail(fmt::format("the {} file cannot be opened for reading", called));
  std::string text(static_cast<std::size_t>(largest + 1), '\0');
  in.read(text.data(), largest + 1);
  if (in.bad()) fail(fmt::format("the {} file cannot be read", called));
  if (in.gcount() > largest)
    fail(fmt::format("the file is larger than {} MiB, which {}", largest >> 20, beyond));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

toml::table parse_toml(std::string_view text, const std::filesystem::path& name) {
  const std::string file = name.string();
  require_shallow(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    std::ranges::replace_if(
        what, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("this is not TOML: {}{}", what, remedy_of_number(text, error.source().begin.line)),
        location_of(error.source(), file));
  }
}

Location location_of(const toml::source_region& where, const std::string& otherwise) {
  return {where.path ? *where.path : otherwise, static_cast<int>(where.begin.line),
          static_cast<int>(where.begin.column)};
}

std::filesystem::path beside(const Location& place, const std::filesystem::path& file) {
  std::error_code unknown;
  const std::filesystem::path naming = place.file;
  const std::filesystem::path here = naming.parent_path() / file, plain = here.lexically_normal();
  if (std::filesystem::equivalent(here, plain, unknown)) return plain;
  if (std::filesystem::exists(here, unknown)) return here;
  const std::filesystem::path there = std::filesystem::canonical(naming, unknown).parent_path() / file;
  return !unknown && std::filesystem::exists(there, unknown) ? there.lexically_normal() : plain;
}

}  // namespace bernal
