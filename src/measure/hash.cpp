#include <bit>

#include <fmt/format.h>

#include "bernal/measure/measure.hpp"

namespace bernal {
namespace {

// Fowler, Noll & Vo, 64-bit FNV-1a (RFC 9923).
constexpr std::uint64_t fnv_offset_basis = 0xcbf29ce484222325;
constexpr std::uint64_t fnv_prime = 0x100000001b3;

std::uint64_t absorb(std::uint64_t hash, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (int shift = 0; shift < 64; shift += 8) hash = (hash ^ ((bits >> shift) & 0xff)) * fnv_prime;
  return hash;
}

}  // namespace

std::string hash_of(const Spheres<dynamic>& spheres) {
  std::uint64_t hash = fnv_offset_basis;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (const auto& column : spheres.x) hash = absorb(hash, column[i]);
    hash = absorb(hash, spheres.r[i]);
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace bernal
