#pragma once
#include "settle/mover.hpp"

namespace bernal {

/// Moves sphere i to first touch along the unit vector `direction`, and on along what its contacts leave of
/// that direction: in the plane of one contact or along the line of two, until they hold it, the `limit` on
/// the length of the way is used up or its bounding box ends. That is rolling without friction. Every leg is
/// one `free_path`, so no gap ever falls below skin/2.
///
/// Returns how far the sphere is from where it was. Cost: one pass over the neighbours, and one more a leg.
double slide(Mover& mover, Bed::Id i, const Vector<3>& direction, double limit);

}  // namespace bernal
