#pragma once
#include <cstdint>
#include <string>

#include "bernal/measure/contacts.hpp"
#include "bernal/run/packing.hpp"

namespace bernal {

/// 64-bit FNV-1a of the doubles of all spheres in order, the coordinates and r of each, little-endian; 16
/// hexadecimal digits.
std::string hash_of(const Spheres<dynamic>&);

}  // namespace bernal
