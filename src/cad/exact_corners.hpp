#pragma once
#include <span>
#include <vector>

#include "bernal/core/unit.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Sets the exact corners of a mesh that was converted from another unit. A vertex at a corner of the file
/// converted by `v *= ratio.nearest()` is exactly that corner times the ratio; a vertex of a removed obstacle
/// is that obstacle's corner; all others, made by a repair, a plane or a cut, are exactly their doubles. Sets
/// nothing if all are doubles. If two corners of the file coincide after conversion, one of them is taken.
/// `as_written`: the corners in the file.
///
/// Cost: O(n log n), about a microsecond a vertex; O(n) if the vertices are those of the file in its order.
/// order.
void state_exactly(Mesh& mesh, std::span<const Vector<3>> as_written, const Ratio& ratio,
                   std::span<const Mesh> taken_out);

}  // namespace bernal::cad
