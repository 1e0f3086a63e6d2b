#pragma once
#include <string>

#include <fmt/format.h>

namespace bernal {

/// Lengths that spheres may have, in any unit: what a scene may start from as well.
inline constexpr double smallest_length = 1e-30, farthest_place = 1e30;

inline bool is_size(double length) { return length >= smallest_length && length <= farthest_place; }
inline std::string complaint_of_size(double length, bool is_diameter) {
  return fmt::format("the {} {} is not a length from {} to {}", is_diameter ? "diameter" : "radius", length,
                     smallest_length, farthest_place);
}

}  // namespace bernal
