#include "manual.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include <fmt/format.h>

namespace {

/// Takes the first character, of more than one byte, off a text in UTF-8.
std::uint32_t take_character(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  std::uint32_t code = first & (0xFFu >> (length + 1));
  for (const char c : text.substr(1, length - 1)) code = code << 6 | (static_cast<unsigned char>(c) & 0x3Fu);
  text.remove_prefix(std::min(length, text.size()));
  return code;
}

/// Text for roff, which shows it as it is: requests, escapes and hyphens are escaped.
std::string plain(std::string_view text) {
  std::string roff;
  while (!text.empty()) {
    const char c = text.front();
    if (static_cast<unsigned char>(c) >= 0x80) {
      roff += fmt::format("\\[u{:04X}]", take_character(text));
      continue;
    }
    if ((c == '.' || c == '\'') && (roff.empty() || roff.back() == '\n')) roff += "\\&";
    switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";
        break;
      case '\'':
        roff += "\\(aq";
        break;
      case '`':
        roff += "\\(ga";
        break;
      case '^':
        roff += "\\(ha";
        break;
      case '~':
        roff += "\\(ti";
        break;
      case '"':
        roff += "\\(dq";
        break;
      default:
        roff += c;
    }
    text.remove_prefix(1);
  }
  return roff;
}

std::string bold(std::string_view text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + plain(text) + "\\fR"; }

/// A sentence with a small first letter: "run a scene". Names in capitals such as CAD stay.
std::string begun_small(std::string text) {
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])) != 0)
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string begun_large(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string roff_paragraphs(std::string_view text, std::string_view between = ".PP\n") {
  std::string roff;
  for (;;) {
    const std::size_t end = text.find("\n\n");
    roff += plain(text.substr(0, end)) + "\n";
    if (end == std::string_view::npos) return roff;
    roff += between;
    text.remove_prefix(end + 2);
  }
}

/// A list of names, each followed by its meaning on the same line or, behind a long name, on the next.
std::string entries(const std::vector<Entry>& all) {
  std::string roff;
  for (const Entry& entry : all) {
    std::string what = entry.what;
    for (std::size_t at = 0; (at = what.find('\n', at)) != std::string::npos; at += 2)
      what.insert(at, 1, '\n');
    roff += fmt::format(".TP\n{}\n{}", bold(entry.name), roff_paragraphs(what, ".br\n"));
  }
  return roff;
}

/// Examples. A reader copies a call from the page, so a long one is broken with a backslash.
std::string call(std::string_view words) {
  constexpr std::size_t widest = 62;
  std::string roff;
  std::size_t column = 0;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    const std::string_view word = words.substr(0, end);
    if (column > 0 && column + 1 + word.size() > widest) {
      roff += " \\e\n    ";
      column = 4;
    } else if (column > 0) {
      roff += " ";
      ++column;
    }
    roff += plain(word);
    column += word.size();
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return roff + "\n";
}

std::string examples(const std::vector<Entry>& all) {
  std::string roff;
  for (const Entry& example : all)
    roff += (roff.empty() ? "" : ".PP\n") + plain(begun_large(example.what)) +
            (example.what.ends_with('?') ? "" : ":") + "\n.PP\n.RS 4\n.EX\n" + call(example.name) +
            ".EE\n.RE\n";
  return roff;
}

std::string list(const std::vector<std::string>& words) {
  std::string all;
  for (std::size_t i = 0; i < words.size(); ++i)
    all += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  return all;
}

/// "-o, --output DIR"
std::string head(const Option& option) {
  std::string roff;
  for (const std::string& name : option.all_names())
    roff += (roff.empty() ? "" : ", ") + (option.is_positional() ? italic(option.placeholder()) : bold(name));
  if (const std::string value = option.placeholder(); !option.is_positional() && !value.empty())
    roff += " " + italic(value);
  return roff;
}

/// What an option is, and its words, range and conditions where the text does not name them.
std::string body(const Option& option) {
  std::string text = begun_large(option.what) + ".";
  const auto says = [&](const std::string& word) { return option.what.find(word) != std::string::npos; };
  if (!option.words.empty() && !says("below") && option.words.size() <= 30 &&
      !std::ranges::all_of(option.words, says))
    text += " One of " + list(option.words) + ".";
  if (!option.range.empty()) text += " From " + option.range + ".";
  if (option.repeated) text += " May be given again.";
  if (!option.needs.empty()) text += " With " + list(option.needs) + ".";
  if (!option.excludes.empty()) text += " Not with " + list(option.excludes) + ".";
  return plain(text) + "\n";
}

std::string options(const std::vector<Option>& all, bool of_all) {
  std::string roff;
  for (const bool positional : {true, false})
    for (const Option& option : all)
      if (option.is_positional() == positional) roff += ".TP\n" + head(option) + "\n" + body(option);
  roff += ".TP\n" + bold("-h") + ", " + bold("--help") + "\nSay the same in short.\n";
  if (of_all) roff += ".TP\n" + bold("--version") + "\nSay the version.\n";
  return roff;
}

std::string synopsis(const Command& command, const std::string& whole) {
  std::string roff = ".B " + plain(whole) + "\n";
  if (!command.commands.empty()) return roff + italic("COMMAND") + " [" + italic("OPTION") + "]...\\&\n";
  std::string places;
  bool optional = false;
  for (const Option& option : command.options) {
    std::string word = option.is_positional()
                           ? italic(option.placeholder())
                           : bold(option.all_names().front()) + " " + italic(option.placeholder());
    if (!option.required) word = "[" + word + "]";
    if (option.is_positional())
      places += " " + word + (std::holds_alternative<std::vector<std::string>*>(option.to) ? "..." : "");
    else if (option.required)
      roff += word + "\n";
    else
      optional = true;
  }
  if (optional) roff += "[" + italic("OPTION") + "]...\\&\n";
  return places.empty() ? roff : roff + places.substr(1) + "\n";
}

std::string dashed(std::string whole) {
  std::ranges::replace(whole, ' ', '-');
  return whole;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// The pages under SEE ALSO: of the command's own commands, of the command that it belongs to, and of others
/// that its text or its examples name.
std::vector<std::string> related(const Command& command, const std::string& whole, const Command& bernal) {
  std::vector<std::string> pages;
  if (whole != bernal.name) pages.push_back(dashed(whole.substr(0, whole.rfind(' '))));
  for (const Command& of : command.commands) pages.push_back(dashed(whole + " " + of.name));
  std::string said = command.explanation.text;
  for (const Entry& example : command.explanation.examples) said += " " + example.name + " ";
  for (const Explanation::List& list : command.explanation.lists) said += " " + list.text;
  for (const Command& other : bernal.commands)
    if (const std::string name = bernal.name + " " + other.name;
        name != whole && whole != bernal.name && said.find(name) != std::string::npos)
      pages.push_back(dashed(name));
  std::ranges::sort(pages);
  pages.erase(std::ranges::unique(pages).begin(), pages.end());
  return pages;
}

class Writer {
 public:
  Writer(const Command& bernal, const std::string& version, const std::string& day)
      : bernal_(bernal), version_(version), day_(day) {}

  void write(const Command& command, const std::string& whole, std::vector<Page>& pages) const {
    const Explanation& more = command.explanation;
    const bool of_all = &command == &bernal_;
    const std::size_t sentence = command.what.find('\n');
    std::string what = begun_small(command.what.substr(0, sentence));
    if (what.ends_with('.')) what.pop_back();
    if (what.starts_with(bernal_.name + " ")) what.erase(0, bernal_.name.size() + 1);

    std::string text = fmt::format(".TH {} 1 {} \"{}\" \"User Commands\"\n", plain(upper(dashed(whole))),
                                   day_, plain(version_));
    text += ".SH NAME\n" + plain(dashed(whole)) + " \\- " + plain(what) + "\n";
    text += ".SH SYNOPSIS\n" + synopsis(command, whole);
    if (of_all) text += ".br\n.B " + plain(whole) + "\n" + bold("--help") + " | " + bold("--version") + "\n";
    text += ".SH DESCRIPTION\n" + roff_paragraphs(command.what + (command.what.ends_with('.') ? "" : "."));
    if (!more.text.empty()) text += ".PP\n" + roff_paragraphs(more.text);
    if (!command.commands.empty()) {
      text += ".SH COMMANDS\n";
      std::vector<Entry> commands;
      for (const Command& of : command.commands) commands.push_back({of.name, of.what + "."});
      text += entries(commands);
    }
    text += ".SH OPTIONS\n" + options(command.options, of_all);
    for (const Explanation::List& list : more.lists) {
      text += ".SH " + plain(upper(list.title)) + "\n";
      if (!list.text.empty()) text += plain(begun_large(list.text)) + "\n";
      text += entries(list.entries);
    }
    if (!more.exit_codes.empty()) text += ".SH EXIT STATUS\n" + entries(more.exit_codes);
    if (!more.examples.empty()) text += ".SH EXAMPLES\n" + examples(more.examples);
    text += ".SH SEE ALSO\n";
    const std::vector<std::string> others = related(command, whole, bernal_);
    for (const std::string& page : others)
      text += ".BR \\%" + plain(page) + " (1)" + (page == others.back() ? "\n" : ",\n");
    pages.push_back({dashed(whole), text});
    for (const Command& of : command.commands) write(of, whole + " " + of.name, pages);
  }

 private:
  const Command& bernal_;
  const std::string& version_;
  const std::string& day_;
};

}  // namespace

std::vector<Page> manual_pages(const Command& bernal, const std::string& version, const std::string& day) {
  std::vector<Page> pages;
  Writer(bernal, version, day).write(bernal, bernal.name, pages);
  return pages;
}
