#pragma once
#include <cstddef>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// A mesh of at most `most` triangles, or few more, that looks like the one given: its corners are gathered
/// in the cells of a grid, as coarse as it takes, and what becomes of no area is left out. Not for packing.
/// Cost: O(T) a grid, some of them.
Mesh simplified(const Mesh& mesh, std::size_t most);

}  // namespace bernal
