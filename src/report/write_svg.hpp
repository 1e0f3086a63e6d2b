#pragma once
#include <string>
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// A picture of spheres in their container or periodic box, coloured by radius, with outline, scale bar and
/// key. In three dimensions orthographic with +z up; hidden spheres are left out, so that the file grows with
/// the surface of the packing, not its volume. In two dimensions discs. Empty in other dimensions.
/// Transparent with mid-grey lines, so that it suits light and dark pages. Cost: O(N log N), about 3 µs a
/// sphere at 10⁴ and 0.5 µs at 10⁶.
std::string svg_of(const Spheres<dynamic>& spheres, const Domain& domain, std::string_view unit);

}  // namespace bernal
