#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace bernal {

inline constexpr std::string_view base64_digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Base64 of the numbers' little-endian bytes. Cost: O(n).
template <class T>
std::string base64_of(std::span<const T> numbers) {
  static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
  constexpr std::string_view digits = base64_digits;
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

/// Decodes at most the first `most` bytes of base64; blanks and line feeds are skipped. Parts that were
/// encoded separately, each with its own padding, are concatenated. Stops at the first invalid character.
/// Cost: O(most).
inline std::string bytes_of_base64(std::string_view text, std::size_t most) {
  constexpr auto values = [] {
    std::array<signed char, 256> made{};
    made.fill(-1);
    for (std::size_t k = 0; k < base64_digits.size(); ++k)
      made[static_cast<unsigned char>(base64_digits[k])] = static_cast<signed char>(k);
    return made;
  }();
  std::string bytes;
  bytes.reserve(std::min(most, text.size() / 4 * 3 + 3));
  std::uint32_t four = 0;
  int digits = 0;
  for (const char c : text) {
    if (bytes.size() >= most) break;
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const bool is_padding = c == '=';
    const int digit = is_padding ? 0 : values[static_cast<unsigned char>(c)];
    if (digit < 0) break;
    if (is_padding && digits < 2) {  // of a part whose last byte was already written
      digits = 0;
      continue;
    }
    four = four << 6 | static_cast<std::uint32_t>(digit);
    ++digits;
    if (!is_padding && digits < 4) continue;
    const int whole = is_padding ? digits - 2 : 3;
    four <<= 6 * (4 - digits);
    for (int k = 0; k < whole; ++k) bytes += static_cast<char>(four >> (16 - 8 * k) & 255);
    four = 0;
    digits = 0;
  }
  if (bytes.size() > most) bytes.resize(most);
  return bytes;
}

}  // namespace bernal
