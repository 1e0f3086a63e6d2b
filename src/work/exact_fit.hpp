#pragma once
#include "bernal/core/spheres.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Puts spheres of a periodic box that is larger by no more than rounding in single precision than the one
/// asked for, such as spheres as wide as the box, into the box asked for, if they fit exactly. Tried are
/// their places, moved apart; then those of a simple cubic lattice. Whether they fit is decided in exact
/// arithmetic, of all images. Nothing changes where they do not, where the box has walls, and for more than
/// 1,900 spheres in three dimensions. Cost: where the box is nearly as asked for some milliseconds for 100
/// spheres, seconds for 1,900; else nothing.
void fit_exactly(SpheresInBox& in_box);

}  // namespace bernal
