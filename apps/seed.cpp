#include "seed.hpp"

#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace {

constexpr std::uint64_t largest_seed = (std::uint64_t{1} << 63) - 1;  ///< that a scene can hold

/// CLI11 would take a number that is too large for the largest one.
std::optional<std::uint64_t> parse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size() || seed > largest_seed) return {};
  return seed;
}

std::string complaint(const std::string& text) {
  if (parse_seed(text)) return "";
  return fmt::format("must be a whole number from 0 to {}, not {}", largest_seed, text);
}

}  // namespace

Option add_seed(Command command, const std::string& help, std::function<void(std::uint64_t)> take) {
  const auto take_word = [take = std::move(take)](const std::string& text) { take(*parse_seed(text)); };
  return command.add_word("--seed", take_word, help).check(complaint).type_name("N");
}
