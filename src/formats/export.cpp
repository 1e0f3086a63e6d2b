#include "bernal/formats/export.hpp"

#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "formats/format.hpp"

namespace bernal {
namespace {

using schema::Key;
using schema::Type;
using schema::Value;

template <class Number>
std::optional<Value> number_in(const std::string& word) {
  Number value{};
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// Of a word of a command line; nothing where it is none of that type.
std::optional<Value> value_of_word(const Key& key, const std::string& word) {
  switch (key.type) {
    case Type::integer:
      return number_in<std::int64_t>(word);
    case Type::number:
    case Type::length:
      return number_in<double>(word);
    case Type::flag:
      if (word == "true" || word == "false") return word == "true";
      return std::nullopt;
    default:
      return word;
  }
}

}  // namespace

std::vector<ExportFormat> export_formats() {
  std::vector<ExportFormat> all;
  for (const OutputTable* table : output_tables()) {
    ExportFormat& made =
        all.emplace_back(ExportFormat{std::string(table->name()),
                                      std::string(table->keys.help),
                                      std::string(table->file),
                                      table->unit ? std::string(name_of(*table->unit)) : "the scene's",
                                      std::string(table->sizes),
                                      table->least_dimension,
                                      table->most_dimensions,
                                      {}});
    for (const Key& key : table->keys.keys)
      if (key.name != "file") made.keys.emplace_back(key.name);
  }
  return all;
}

std::vector<ExportKey> export_keys() {
  std::vector<ExportKey> all;
  for (const Key& key : output_keys())
    if (key.name != "file") all.push_back({std::string(key.name), std::string(key.help)});
  return all;
}

Output output_of(std::string_view format, const std::map<std::string, std::string>& words) {
  const auto fail = [](const std::string& what) { throw Error(ErrorCode::bad_argument, what); };
  std::vector<std::string_view> names;
  const OutputTable* table = nullptr;
  for (const OutputTable* known : output_tables()) {
    names.push_back(known->name());
    if (known->name() == format) table = known;
  }
  if (!table) fail(fmt::format("unknown format \"{}\"{}", plain_text(format), remedy(format, names)));
  Output output{.format = std::string(format)};
  for (const auto& [name, word] : words) {
    const Key* key = name == "file" ? nullptr : table->keys.find(name);
    if (!key) {
      std::vector<std::string_view> others;
      for (const OutputTable* other : output_tables())
        if (other->keys.find(name)) others.push_back(other->name());
      fail(fmt::format(
          "the format {} takes no {}; {}", format, name,
          others.empty() ? "no format does" : fmt::format("these do: {}", fmt::join(others, ", "))));
    }
    const std::optional<Value> value = value_of_word(*key, word);
    if (!value || !schema::accepts(*key, *value))
      fail(
          fmt::format("{} must be {}, not \"{}\"", name, schema::expectation(*key, value), plain_text(word)));
    key->member.set(&output, *value);
  }
  for (const auto& [name, word] : words)
    if (const auto users = contacts_that_use(*table->keys.find(name), output); !users.empty())
      fail(fmt::format("{} acts where contact is {} only; say so or leave it out", name, users));
  return output;
}

}  // namespace bernal
