#pragma once
#include <string>
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// A picture of spheres in their container or periodic box, coloured by radius, with its outline, a scale bar
/// and a key. In three dimensions orthographic, +z up; spheres that cannot be seen are left out, so that the
/// size grows with the surface of the packing, not with its volume. In two dimensions discs in the plane. In
/// others there is no picture: empty. The background is transparent and every line is a middle grey, so that
/// it sits on light and dark pages. Cost: O(N log N); about 3 µs a sphere at 10⁴, 0.5 µs at 10⁶.
std::string svg_of(const Spheres<dynamic>& spheres, const Domain& domain, std::string_view unit);

}  // namespace bernal
