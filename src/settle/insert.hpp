#pragma once
#include "bernal/settle/insert.hpp"
#include "work/work.hpp"

namespace bernal {

/// Random sequential insertion: the spheres that are still to come, in order, each at a uniformly random
/// place where it overlaps nothing (Han, Feng & Owen 2005, section 2: the initial packing). Ends when the
/// target or the given packing fraction is reached, or nothing in the window found a place. Cost: O(1) a
/// trial.
StageEnd insert(Work& work, const Insert& options);

/// The same for the first `count` of the drawn sequence, all anew, but the largest first: for sizes of which
/// some have hardly any room where small ones stand. What finds no place is passed over. Ends at once when it
/// can no longer become as dense as that.
StageEnd insert_largest_first(Work& work, std::size_t count, double densest_so_far = 0);

}  // namespace bernal
