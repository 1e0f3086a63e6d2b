#pragma once
#include "bernal/settle/insert.hpp"
#include "work/work.hpp"

namespace bernal {

/// Random sequential insertion: the spheres that are still to come, in order, each at a uniformly random
/// place where it overlaps nothing (Han, Feng & Owen 2005, section 2: the initial packing). Ends when the
/// target or the given packing fraction is reached, or nothing in the window found a place. Cost: O(1) a
/// trial.
StageEnd insert(Work& work, const Insert& options);

}  // namespace bernal
