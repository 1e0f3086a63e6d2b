#include "populations.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

using namespace bernal;

namespace {

constexpr std::size_t most_populations = 10'000;
constexpr std::size_t longest_input = 1 << 22;
/// The largest width. Of wider sizes the largest spheres, which have the volume, are missing among the rods.
constexpr double widest = 5;

[[noreturn]] void refuse(const std::string& where, const std::string& why) {
  throw Error(ErrorCode::bad_argument, fmt::format("{}: {}", where, why));
}

void require_few(std::size_t populations) {
  if (populations > most_populations)
    throw Error(ErrorCode::bad_argument,
                fmt::format("more than {} populations of spheres; put neighbouring sizes together first",
                            most_populations));
}

/// The words between separators; between two adjacent ones stands an empty word.
std::vector<std::string_view> words_in(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  for (;;) {
    const std::size_t end = text.find_first_of(separators);
    words.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end + 1);
  }
}

double number_of(std::string_view word, const std::string& where) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failed == std::errc::result_out_of_range)
    refuse(where, fmt::format("\"{}\" is out of the range of numbers", word.substr(0, 40)));
  if (failed != std::errc() || end != word.data() + word.size())
    refuse(where, fmt::format("\"{}\" is not a number", word.substr(0, 40)));
  return value;
}

double positive(double value, std::string_view what, const std::string& where) {
  if (!(value > 0 && std::isfinite(value)))
    refuse(where, fmt::format("{} must be positive and finite, not {}", what, value));
  return value;
}

Population checked(Population p, const std::string& where) {
  positive(p.d43, "a diameter", where);
  if (!(p.sigma >= 0 && p.sigma <= widest))
    refuse(where, fmt::format("sigma must lie from 0 to {}, not {}", widest, p.sigma));
  if (!(p.volume >= 0 && std::isfinite(p.volume)))
    refuse(where, fmt::format("a volume must be finite and not negative, but is {}", p.volume));
  return p;
}

Population of_means(double d43, double d32, double volume, const std::string& where) {
  positive(d43, "a diameter", where);
  positive(d32, "a diameter", where);
  if (d43 < d32)
    refuse(where, fmt::format("d43 is never below d32, but {} is below {}; are they swapped?", d43, d32));
  return checked({d43, std::sqrt(std::log(d43) - std::log(d32)), volume}, where);
}

std::vector<double> numbers_of(const std::vector<std::string_view>& words, const std::string& where) {
  std::vector<double> numbers;
  for (const std::string_view word : words) numbers.push_back(number_of(word, where));
  return numbers;
}

}  // namespace

Population parse_lognormal(const std::string& text, const std::string& where) {
  const std::vector<std::string_view> words = words_in(text, ",");
  if (words.size() != 1 && words.size() != 3)
    refuse(where, fmt::format("\"{}\" is neither SIGMA nor D43,D32,VOLUME", text));
  const std::vector<double> n = numbers_of(words, where);
  return n.size() == 1 ? checked({1, n[0], 1}, where) : of_means(n[0], n[1], n[2], where);
}

Population parse_lognormal_means(const std::string& text, const std::string& where) {
  const std::vector<std::string_view> words = words_in(text, ",");
  if (words.size() != 2) refuse(where, fmt::format("\"{}\" is not D43,D32", text.substr(0, 40)));
  const std::vector<double> n = numbers_of(words, where);
  return of_means(n[0], n[1], 1, where);
}

std::vector<Population> parse_diameters(const std::string& text, const std::string& where) {
  std::vector<Population> populations;
  for (const std::string_view word : words_in(text, ",")) {
    populations.push_back(checked({number_of(word, where), 0, 1}, where));
    require_few(populations.size());
  }
  return populations;
}

std::vector<Population> parse_classes(const std::string& text, const std::string& where) {
  std::vector<Population> populations;
  for (const std::string_view item : words_in(text, ",")) {
    const std::vector<std::string_view> words = words_in(item, ":");
    if (words.size() != 2) refuse(where, fmt::format("\"{}\" is not DIAMETER:VOLUME", item.substr(0, 40)));
    populations.push_back(checked({number_of(words[0], where), 0, number_of(words[1], where)}, where));
    require_few(populations.size());
  }
  return populations;
}

std::vector<Population> read_populations(std::istream& in, char format) {
  std::string text(longest_input + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > longest_input)
    throw Error(ErrorCode::bad_argument, "standard input: more than 4 MB; put neighbouring sizes together");

  const std::size_t columns = format == 'd' ? 2 : 3;
  const char* const what = format == 'd'   ? "diameter volume"
                           : format == 'l' ? "d43 d32 volume"
                                           : "d43 sigma volume";
  std::vector<Population> populations;
  std::size_t line_number = 0;
  for (const std::string_view line : words_in(text, "\n")) {
    const std::string where = fmt::format("standard input, line {}", ++line_number);
    std::vector<std::string_view> words = words_in(line.substr(0, line.find('#')), " \t\r,;");
    std::erase(words, "");
    const std::vector<double> n = numbers_of(words, where);
    if (n.empty()) continue;
    if (n.size() != columns)
      refuse(where, fmt::format("{} numbers, where {} are expected: {}", n.size(), columns, what));
    if (format == 'd') populations.push_back(checked({n[0], 0, n[1]}, where));
    if (format == 'l') populations.push_back(of_means(n[0], n[1], n[2], where));
    if (format == 'w') populations.push_back(checked({n[0], n[1], n[2]}, where));
    require_few(populations.size());
  }
  if (populations.empty())
    throw Error(ErrorCode::bad_argument, fmt::format("standard input: no population; a line is {}", what));
  return populations;
}

Mixture sizes_of(const std::vector<Population>& populations) {
  double largest = 0, all = 0;
  for (const Population& p : populations) {
    if (p.volume > 0) largest = std::max(largest, p.d43);
    all = std::max(all, p.volume);
  }
  if (!(all > 0)) throw Error(ErrorCode::bad_argument, "all populations have volume zero");

  std::map<double, double> classes;  // the volume of each radius
  Mixture mixture{.of = {}, .basis = Basis::volume};
  for (const Population& p : populations) {
    const double radius = p.d43 / largest, share = p.volume / all;
    if (!(share > 0)) continue;
    if (!(radius > 1e-60))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("diameters from {:g} to {:g} are too far apart", p.d43, largest));
    if (p.sigma < 1e-9) {
      classes[radius] += share;
    } else {
      const double median = radius * std::exp(-0.5 * p.sigma * p.sigma);  // d43 = median by volume e^(s²/2)
      mixture.of.emplace_back(Lognormal{.median = median, .sigma = p.sigma, .basis = Basis::volume});
      mixture.shares.push_back(share);
    }
  }
  if (!classes.empty()) {
    Classes all_classes{.basis = Basis::volume};
    double total = 0;
    for (const auto& [radius, volume] : classes) {
      all_classes.values.push_back(radius);
      all_classes.shares.push_back(volume);
      total += volume;
    }
    mixture.of.push_back(std::move(all_classes));
    mixture.shares.push_back(total);
  }
  return mixture;
}
