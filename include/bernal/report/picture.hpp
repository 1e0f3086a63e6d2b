#pragma once
#include <string>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// The picture of a packing as SVG, that of `packing.svg`: spheres coloured by radius in their container or
/// periodic box, with a scale bar and a key; of a box with very many spheres, a corner; discs in two
/// dimensions. Empty in other than two or three dimensions. Transparent with mid-grey lines, so that it suits
/// light and dark pages. Precondition: centres in one period. Cost: O(N log N), about 3 µs a sphere at 10⁴
/// and 0.5 µs at 10⁶.
std::string picture_of(const Packing&);

}  // namespace bernal
