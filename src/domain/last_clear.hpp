#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

namespace bernal {

/// The last double in [0, limit) before `clears` becomes false, which it is at the limit and not at 0.
/// Doubles of one sign are in the order of their bits. Cost: two questions where the guess is right, twice
/// the logarithm of how many doubles it is off otherwise.
template <class Clears>
double last_clear(double guess, double limit, const Clears& clears) {
  const auto value = [](std::uint64_t bits) { return std::bit_cast<double>(bits); };
  std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(limit);
  std::uint64_t at = std::bit_cast<std::uint64_t>(guess > 0 ? std::min(guess, limit) : 0.0);
  at = std::min(at, high - 1);
  if (clears(value(at))) {
    low = at;
    for (std::uint64_t step = 1; high - low > step; step *= 2) {
      if (!clears(value(low + step))) {
        high = low + step;
        break;
      }
      low += step;
    }
  } else {
    high = at;
    for (std::uint64_t step = 1; high - low > step; step *= 2) {
      if (clears(value(high - step))) {
        low = high - step;
        break;
      }
      high -= step;
    }
  }
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (clears(value(middle)) ? low : high) = middle;
  }
  return value(low);
}

}  // namespace bernal
