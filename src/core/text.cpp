#include "bernal/core/text.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace bernal {
namespace {

char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Damerau–Levenshtein distance in its "optimal string alignment" form: insertions, deletions, substitutions
/// and swaps of neighbouring letters; case does not count. Cost: the product of the lengths.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const auto same = [&](std::size_t p, std::size_t q) { return lower_case(a[p]) == lower_case(b[q]); };
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(i - 1, j - 1) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1))
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = std::exchange(last, row);
  }
  return last[b.size()];
}

/// The bytes of the character that a text begins with, 0 if that is none in UTF-8; and its number.
std::size_t character_at(std::string_view text, char32_t& number) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const std::size_t size = byte(0) < 0x80                       ? 1
                           : byte(0) >= 0xc2 && byte(0) <= 0xdf ? 2
                           : byte(0) >= 0xe0 && byte(0) <= 0xef ? 3
                           : byte(0) >= 0xf0 && byte(0) <= 0xf4 ? 4
                                                                : 0;
  if (size == 0 || size > text.size()) return 0;
  number = size == 1 ? byte(0) : byte(0) & (0x7fU >> size);
  for (std::size_t k = 1; k < size; ++k) {
    if ((byte(k) & 0xc0U) != 0x80) return 0;
    number = number << 6U | (byte(k) & 0x3fU);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = number >= 0xd800 && number <= 0xdfff;
  return number < least[size] || number > 0x10ffff || surrogate ? 0 : size;
}

/// The first character of a text, which is taken off: `valid` if it is one of UTF-8, else a single byte.
struct Character {
  std::string_view bytes;
  char32_t number = 0;
  bool valid = false;
};
Character take_character(std::string_view& text) {
  Character taken;
  const std::size_t size = character_at(text, taken.number);
  taken.valid = size > 0;
  taken.bytes = text.substr(0, taken.valid ? size : 1);
  text.remove_prefix(taken.bytes.size());
  return taken;
}

/// Moves a terminal's cursor, turns the direction of writing, or ends a line.
bool is_control(char32_t c) {
  const auto within = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
  return c < 0x20 || within(0x7f, 0x9f) || within(0x200e, 0x200f) || within(0x2028, 0x202e) ||
         within(0x2066, 0x2069) || c == 0x61c || c == 0xfeff;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty())
    if (!take_character(text).valid) return false;
  return true;
}

std::string plain_text(std::string_view text, std::size_t most) {
  std::vector<std::string_view> characters;
  std::size_t bytes = 0;
  while (!text.empty()) {
    const Character next = take_character(text);
    characters.push_back(!next.valid ? "?" : is_control(next.number) ? " " : next.bytes);
    bytes += characters.back().size();
  }
  std::string plain;
  std::size_t k = 0;
  if (bytes > most) {  // two thirds from the front, where the name of the file stands, the rest from the end
    constexpr std::string_view left_out = " … ";
    const std::size_t room = most - std::min(most, left_out.size());
    for (; k < characters.size() && plain.size() + characters[k].size() <= 2 * room / 3; ++k)
      plain += characters[k];
    std::size_t end = characters.size();
    for (std::size_t tail = 0; end > k && tail + characters[end - 1].size() <= room - plain.size(); --end)
      tail += characters[end - 1].size();
    plain += left_out;
    k = end;
  }
  for (; k < characters.size(); ++k) plain += characters[k];
  return plain;
}

std::string with_escaped_controls(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character next = take_character(text);
    if (next.valid && is_control(next.number))
      result += fmt::format("\\u{:04X}", static_cast<std::uint32_t>(next.number));
    else
      result += next.bytes;
  }
  return result;
}

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
  std::string_view nearest;
  std::size_t least = 0;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (3 * distance > std::max(name.size(), candidate.size())) continue;
    if (nearest.empty() || distance < least) {
      nearest = candidate;
      least = distance;
    }
  }
  return nearest;
}

std::string remedy(std::string_view name, std::span<const std::string_view> candidates) {
  if (const std::string_view near = nearest_name(name, candidates); !near.empty())
    return "; did you mean \"" + std::string(near) + "\"?";
  std::string known;
  for (const std::string_view candidate : candidates)
    known += (known.empty() ? "; known: \"" : ", \"") + std::string(candidate) + '"';
  return known;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n\v\f";
  const std::size_t first = text.find_first_not_of(blank);
  return first == text.npos ? text.substr(0, 0)
                            : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string with_options(std::string_view message, const OptionInWords& in_words) {
  constexpr std::string_view begin = "‹", end = "›";
  std::string text;
  while (!message.empty()) {
    const std::size_t from = message.find(begin);
    text += message.substr(0, from);
    if (from == message.npos) break;
    message.remove_prefix(from);
    const std::size_t to = message.find(end);
    std::string_view option = message.substr(0, to);
    option.remove_prefix(begin.size());
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string_view name = option.substr(0, equals);
    if (to == message.npos || name.empty() ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") != name.npos) {
      text += begin;
      message.remove_prefix(begin.size());
      continue;
    }
    text += in_words(name, option.substr(std::min(equals + 1, option.size())));
    message.remove_prefix(to + end.size());
  }
  return text;
}

std::string in_dimension(int dimension, std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> words[] = {
      {"spheres", "discs"}, {"sphere", "disc"}, {"Spheres", "Discs"}, {"Sphere", "Disc"}};
  constexpr std::string_view names_before = "_[\"'/=.#<", names_after = "_]\"'/=";
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  if (dimension != 2) return std::string(text);
  std::string all;
  for (std::size_t at = 0; at < text.size();) {
    const char before = at > 0 ? text[at - 1] : ' ';
    const auto found = std::ranges::find_if(words, [&](const auto& word) {
      return text.substr(at).starts_with(word.first) &&
             !is_letter(at + word.first.size() < text.size() ? text[at + word.first.size()] : ' ');
    });
    if (found == std::end(words) || is_letter(before) || names_before.find(before) != text.npos) {
      all += text[at++];
      continue;
    }
    const auto& [sphere, disc] = *found;
    const std::string_view rest = text.substr(at + sphere.size());
    const bool is_name =
        (!rest.empty() && names_after.find(rest[0]) != rest.npos && !rest.starts_with("'s")) ||
        (rest.size() > 1 && rest[0] == '.' && is_letter(rest[1]));
    const std::string blanks(sphere.size() - disc.size(), ' ');
    if (!is_name && all.ends_with("  ") && !rest.starts_with("  ")) all += blanks;
    all += is_name ? sphere : disc;
    if (!is_name && rest.starts_with("  ")) all += blanks;
    at += sphere.size();
  }
  return all;
}

std::string grouped(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t from_right = 3; from_right < digits.size(); from_right += 4) {
    digits.insert(digits.size() - from_right, 1, ',');
  }
  return digits;
}

}  // namespace bernal
