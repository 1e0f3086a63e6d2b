#pragma once
#include <cstdint>
#include <string>

#include "bernal/run/packing.hpp"

namespace bernal {

/// What touches what. A *contact* is a pair (or a sphere and a wall) whose gap is below `contact_gap`:
/// gap ratio = (d - ri - rj) / (ri + rj) for a pair, (clearance - r) / r for a wall.
struct Contacts {
  double contact_gap = 0.002;
  std::uint64_t pairs = 0;        ///< sphere-sphere contacts
  std::uint64_t walls = 0;        ///< sphere-wall contacts, one a facet, edge or corner
  std::uint64_t rattlers = 0;     ///< spheres with fewer than 4 contacts, removed until none is left
  double coordination = 0;        ///< mean number of sphere contacts of a sphere: 2 pairs / N
};

/// Cost O(N). The packing is in the scene's frame; nothing is changed.
Contacts measure_contacts(const Packing&, double contact_gap = 0.002);

/// 64-bit FNV-1a of the doubles of all spheres in order, the coordinates and r of each, little-endian; 16 hexadecimal digits.
std::string hash_of(const Spheres<dynamic>&);

}  // namespace bernal
