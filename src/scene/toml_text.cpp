#include "scene/toml_text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/scene_entries.hpp"

namespace bernal {

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out += '"';
}

namespace {

/// An inline table.
std::string text_of(const SceneSizes& sizes) {
  const schema::Entry& entry = schema::entry_of(sizes);
  return fmt::format("{{ distribution = {}, {} }}", toml_string(entry.name),
                     fmt::join(assignments(entry, schema::options_of(sizes)), ", "));
}

}  // namespace

std::string toml_text(const schema::Value& value) {
  struct {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
    std::string operator()(double v) const { return fmt::format("{}", v); }
    std::string operator()(const std::string& v) const { return toml_string(v); }
    std::string operator()(const std::vector<double>& v) const {
      return fmt::format("[{}]", fmt::join(v, ", "));
    }
    std::string operator()(const std::vector<SceneSizes>& v) const {
      std::vector<std::string> parts;
      for (const SceneSizes& part : v) parts.push_back(text_of(part));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    }
  } write;
  return std::visit(write, value);
}

std::vector<std::string> assignments(const schema::Entry& entry, const void* options, bool in_bed) {
  const auto absent = entry.left_out(options, {std::string(entry.name), {}});
  std::vector<std::string> out;
  for (const schema::Key& key : entry.keys) {
    const auto value = key.of(options);
    if (!value || !key.acts_here(in_bed) || std::ranges::find(absent, key.name) != absent.end()) continue;
    const bool one = key.type == schema::Type::distribution;
    out.push_back(
        fmt::format("{} = {}", key.name,
                    one ? text_of(std::get<std::vector<SceneSizes>>(*value).front()) : toml_text(*value)));
  }
  return out;
}

}  // namespace bernal
