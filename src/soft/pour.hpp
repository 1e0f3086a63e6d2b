#pragma once
#include "soft/below_level.hpp"
#include "soft/settle_as_dense.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// Gives the spheres of the drawn sequence that have no place one above those that have: relaxation packs
/// them in the part of the container that they fill at the packing fraction that `how` says, or the lowest
/// larger one in which there is room for them; where the bed's height is given, or the container does not
/// hold them, as many as have that packing fraction. What stands there stays where it is. `whole`: what of
/// the container it leaves, and `heights` of that. Cost: that of relaxation.
StageEnd pour(SpheresInBed& in_bed, Reporter& report, const BedTop& top,
              const std::shared_ptr<const Container>& whole, const Heights& heights, Laying& how);

/// Those that stand there fall and roll to rest, as they do without any that are still to come: what rested
/// then stays where it is, however small those are.
StageEnd rest_first(Bed& bed, const Reporter& report, const Vector<3>& down, double still);

}  // namespace bernal
