#pragma once
#include <cstdint>

namespace bernal {

/// A sphere of the fast relaxation. Its place on axis k is x[k] in units of edge / 2^32, so that differences
/// wrap round to the minimum image by themselves and a growing box leaves the coordinates as they are.
/// Resolution: 2^-33 of the edge, 1e-8 radii in a box of 10,000 spheres. A radius of NaN stands for no
/// sphere: it touches nothing.
struct alignas(16) SoftSphere {
  std::int32_t x[3];
  float r;
};

/// So many spheres that do not touch each other are moved together.
inline constexpr std::size_t lanes = 16;

}  // namespace bernal
