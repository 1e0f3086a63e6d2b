#pragma once
#include <bit>
#include <cstdint>
#include <string_view>

namespace bernal {

/// Fowler, Noll & Vo, 64-bit FNV-1a (RFC 9923), of bytes one after the other; a double counts as its eight,
/// the least significant first.
class Fnv1a {
 public:
  void absorb(unsigned char byte) { hash_ = (hash_ ^ byte) * 0x100000001b3; }
  void absorb(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (int shift = 0; shift < 64; shift += 8) absorb(static_cast<unsigned char>(bits >> shift));
  }
  void absorb(std::string_view text) {
    for (const char c : text) absorb(static_cast<unsigned char>(c));
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace bernal
