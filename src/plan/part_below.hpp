#pragma once
#include <optional>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// The part of a domain below a plane, normal · p <= offset; nothing where that is empty. A box is cut along
/// its axes; along one that repeats itself the part does not, and ends at walls: at the plane, and where the
/// period begins. A cylinder and a solid of revolution are cut across their axis, a mesh by any plane, in
/// which it is closed. Corners that the plane makes are rounded. Throws Error{bad_argument} with one line for
/// other planes and domains. Cost: O(n log n) of a mesh, else O(n).
std::optional<Domain> part_below(const Domain&, const Vector<3>& normal, double offset);

}  // namespace bernal
