#pragma once
#include "soft/below_level.hpp"
#include "work/work.hpp"

namespace bernal {

/// Gives the spheres of the drawn sequence that have no place one above those that have: relaxation packs
/// them in the part of the container that they fill at the packing fraction `aim`, or the lowest larger one
/// in which there is room for them; where the bed's height is given, or the container does not hold them, as
/// many as have that packing fraction. What stands there stays where it is. Precondition: the spheres stand
/// in a bed. Cost: that of relaxation.
StageEnd pour(Work& work, const BedTop& top, const Heights& heights, double aim);

}  // namespace bernal
