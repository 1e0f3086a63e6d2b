#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// A mesh of at most `most` triangles, or few more, that looks like the one given: its corners are gathered
/// in the cells of a grid, as coarse as it takes, and what becomes of no area is left out. Not for packing.
/// Cost: O(T) a grid, some of them.
Mesh simplified(const Mesh& mesh, std::size_t most);

/// The edges by which a shape is recognised: those that bend by more than 30 degrees, and open ones; of more
/// than `most` the longest. Cost: O(T log T).
std::vector<std::array<Vector<3>, 2>> sharp_edges(const Mesh& mesh, std::size_t most);

}  // namespace bernal
