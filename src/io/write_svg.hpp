#pragma once
#include <string>
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// A picture of spheres in their container: orthographic, +z up, coloured by radius, with the container's
/// outline, a scale bar and a key. The background is transparent and every line is a middle grey, so that it
/// sits on light and dark pages. Spheres that cannot be seen are left out: the size grows with the surface of
/// the packing, not with its volume. Cost: O(N log N); about 2 µs a sphere.
std::string svg_of(const Spheres<dynamic>& spheres, const Domain& domain, std::string_view unit);

}  // namespace bernal
