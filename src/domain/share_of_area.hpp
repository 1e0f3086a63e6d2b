#pragma once
#include <cstddef>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// What a closed line of a polygon adds to its area: a line that an even number of others encloses bounds the
/// region from outside, another one a hole in it, which counts negative.
double share_of_area(const Polygon&, std::size_t loop);

}  // namespace bernal
