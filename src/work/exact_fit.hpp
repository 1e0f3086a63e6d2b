#pragma once
#include "bernal/core/spheres.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Of few spheres in a periodic box that is larger by no more than rounding than the one asked for, such as
/// one as wide as the box: puts them into the box asked for, if they fit exactly. Tried are their places,
/// moved apart by roundings; then those of a simple cubic lattice. Whether they fit is decided in exact
/// arithmetic, of all images. Nothing changes where they do not, where the box has walls, and of more than
/// some hundred spheres. Cost: some milliseconds, where the box is nearly as asked for; else nothing.
void fit_exactly(SpheresInBox& in_box);

}  // namespace bernal
