#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace bernal {

/// Numbers as base64 of their bytes, least first. Cost: O(n).
template <class T>
std::string base64_of(std::span<const T> numbers) {
  static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t n = numbers.size_bytes();
  const auto* const bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  std::string text;
  text.reserve((n + 2) / 3 * 4);
  for (std::size_t k = 0; k < n; k += 3) {
    std::uint32_t three = std::uint32_t{bytes[k]} << 16;
    if (k + 1 < n) three |= std::uint32_t{bytes[k + 1]} << 8;
    if (k + 2 < n) three |= bytes[k + 2];
    text += digits[three >> 18];
    text += digits[three >> 12 & 63];
    text += k + 1 < n ? digits[three >> 6 & 63] : '=';
    text += k + 2 < n ? digits[three & 63] : '=';
  }
  return text;
}

}  // namespace bernal
