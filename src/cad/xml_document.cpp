#include "cad/xml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <new>
#include <utility>

#include "bernal/core/error.hpp"
#include "cad/known_formats.hpp"

namespace bernal::cad {
namespace {

/// Longer words are no numbers.
constexpr std::size_t most_digits = 1000;

/// As it stands in a phrase.
std::string quoted(std::string_view text) {
  constexpr std::size_t most = 40;
  return fmt::format("\"{}{}\"", text.substr(0, most), text.size() > most ? "..." : "");
}

}  // namespace

XmlDocument::XmlDocument(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)) {
  const pugi::xml_parse_result parsed =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default | pugi::parse_embed_pcdata);
  if (parsed.status == pugi::status_out_of_memory) throw std::bad_alloc();
  const bool empty = parsed.status == pugi::status_no_document_element;
  if (!parsed && !empty)
    refuse_at(static_cast<std::size_t>(parsed.offset),
              fmt::format("it is no well-formed XML or breaks off: {}", parsed.description()));
  if (root().empty()) refuse_at(0, "it holds no XML");
}

void XmlDocument::refuse_at(std::size_t offset, const std::string& what) const {
  std::string place = name_;
  // Of two bytes a character, offsets are not those of the text.
  if (text_.find('\0') == text_.npos) {
    const auto end = text_.begin() + std::ptrdiff_t(std::min(offset, text_.size()));
    const auto line = 1 + std::count(text_.begin(), end, '\n');
    place = name_.empty() ? fmt::format("line {}", line) : fmt::format("line {} of {}", line, name_);
  }
  throw Error(ErrorCode::bad_mesh, place.empty() ? what : fmt::format("{} ({})", what, place));
}

void XmlDocument::refuse(pugi::xml_node at, const std::string& what) const {
  refuse_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(at.offset_debug(), 0)), what);
}

std::optional<double> XmlDocument::number_in(std::string_view text) {
  std::string_view digits = trimmed(text);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  if (digits.empty() || digits.size() > most_digits) return {};
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range)  // zero, if it is too small, else infinite
    value = std::strtod(std::string(digits).c_str(), nullptr);
  const bool whole = error != std::errc::invalid_argument && end == digits.data() + digits.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

void XmlDocument::refuse_number(std::string_view text, pugi::xml_node at, const std::string& what) const {
  refuse(at, fmt::format("{} is {}, no finite number", what, quoted(trimmed(text))));
}

void XmlDocument::refuse_index(std::string_view text, std::size_t count, pugi::xml_node at,
                               const std::string& what) const {
  refuse(at,
         fmt::format("{} names vertex {}, and there are {}, from 0 on", what, quoted(trimmed(text)), count));
}

bool is_named(const char* qualified, std::string_view name) {
  const std::string_view all = qualified;
  if (!all.ends_with(name)) return false;
  return all.size() == name.size() || all[all.size() - name.size() - 1] == ':';
}

pugi::xml_node child_of(pugi::xml_node node, std::string_view name) {
  return node.find_child([&](pugi::xml_node child) { return is_named(child, name); });
}

std::string_view attribute_of(pugi::xml_node node, std::string_view name) {
  return node.find_attribute([&](pugi::xml_attribute a) { return is_named(a.name(), name); }).value();
}

}  // namespace bernal::cad
