#pragma once
#include <cstddef>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// A mesh of about `most` triangles at most that looks like the given one: corners in one cell of a grid are
/// merged, and triangles without area are dropped. Not for packing. Cost: O(T) a grid; a few grids are tried.
Mesh simplified(const Mesh& mesh, std::size_t most);

}  // namespace bernal
