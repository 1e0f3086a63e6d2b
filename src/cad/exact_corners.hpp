#pragma once
#include <span>
#include <vector>

#include "bernal/core/unit.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// States what corners of a mesh are exactly that was converted from another unit: those of its vertices that
/// stand where a corner of the file came to be by `v *= ratio.nearest()` are that corner times the ratio;
/// those of a part that was taken out are that part's; all others, which a repair, a plane or a cut made, are
/// the doubles that they are. Nothing is stated where all of them are doubles anyway. Where two corners of
/// the file came to be in one place one of them is meant. `as_written`: the corners of the file.
///
/// Cost: O(n log n), about a microsecond a vertex; O(n) where the vertices are those of the file in its
/// order.
void state_exactly(Mesh& mesh, std::span<const Vector<3>> as_written, const Ratio& ratio,
                   std::span<const Mesh> taken_out);

}  // namespace bernal::cad
