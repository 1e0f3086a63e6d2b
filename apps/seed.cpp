#include "seed.hpp"

#include <charconv>
#include <utility>

#include <fmt/format.h>

namespace {

constexpr std::uint64_t largest_seed = (std::uint64_t{1} << 63) - 1;  ///< that a scene can hold

/// CLI11 would take a number that is too large for the largest one.
std::uint64_t parse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size() || seed > largest_seed)
    throw CLI::ValidationError(
        "--seed", fmt::format("must be a whole number from 0 to {}, not {}", largest_seed, text));
  return seed;
}

}  // namespace

CLI::Option* add_seed(CLI::App& command, const std::string& help, std::function<void(std::uint64_t)> take) {
  return command
      .add_option_function<std::string>(
          "--seed", [take = std::move(take)](const std::string& text) { take(parse_seed(text)); }, help)
      ->type_name("N");
}
