#include "explanation_text.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "command_line.hpp"

namespace {

constexpr std::size_t widest_name = 52;  ///< beyond it, what it is stands below

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

/// The parts of a text between separators.
std::vector<std::string_view> split(std::string_view text, std::string_view separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + separator.size());
  }
}

std::string paragraphs(std::string_view text) {
  std::string all;
  for (const std::string_view paragraph : split(text, "\n\n"))
    all += (all.empty() ? "" : "\n\n") + wrapped(paragraph, 0);
  return all + "\n";
}

/// "  name      what it is", the second in a column.
std::string as_lines(const std::vector<Entry>& entries) {
  std::size_t column = 6;
  for (const Entry& entry : entries)
    if (const std::size_t own = characters(entry.name); own <= widest_name)
      column = std::max(column, own + 4);
  const std::string below = fmt::format("\n{}", std::string(column, ' '));
  std::string text;
  for (const Entry& entry : entries) {
    std::string before = "  " + entry.name;
    const std::size_t own = characters(before);
    if (!entry.what.empty()) before += own + 2 > column ? below : std::string(column - own, ' ');
    for (const std::string_view what : split(entry.what, "\n")) {
      text += before + wrapped(what, column, 110, column);
      before = below;
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string wrapped(std::string_view text, std::size_t indent, std::size_t width, std::size_t column) {
  std::string lines;
  bool begins = true;
  for (std::string_view word : split(text, " ")) {
    for (const std::string_view part : split(word, "\n")) {
      if (part.empty()) continue;
      const std::size_t length = characters(part);
      if (!begins && column + 1 + length > width) {
        lines += '\n';
        lines.append(indent, ' ');
        column = indent;
        begins = true;
      }
      if (!begins) lines += ' ';
      lines += part;
      column += length + (begins ? 0 : 1);
      begins = false;
    }
  }
  return lines;
}

std::string explanation_as_text(const Explanation& explanation) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "\n") + part; };
  if (!explanation.text.empty()) add(paragraphs(explanation.text));
  for (const Explanation::List& list : explanation.lists) {
    add(wrapped(list.title + ": " + list.text, 0) + "\n" + as_lines(list.entries));
  }
  if (!explanation.examples.empty()) add("Examples:\n" + as_lines(explanation.examples));
  if (!explanation.exit_codes.empty()) {
    std::string codes = "Exit codes:";
    const char* before = " ";
    for (const Entry& code : explanation.exit_codes) {
      codes += before + code.name + " " + code.what;
      before = "; ";
    }
    add(wrapped(codes + ".", 0));
  }
  while (text.ends_with('\n')) text.pop_back();
  return text;
}
