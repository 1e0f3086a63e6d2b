#pragma once
#include "soft/below_level.hpp"
#include "soft/settle_as_dense.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// Places those spheres of the drawn sequence that have no place yet above those that have one. Relaxation
/// packs them in the part of the container that they fill at the packing fraction of `how`, or in the
/// smallest larger part that has room for them. If the height of the bed is given, or the container does not
/// hold all, it places as many as have that packing fraction. Spheres that stand there stay where they are.
/// `whole` is the part of the container that they leave, and `heights` belongs to it. Precondition: the
/// spheres stand in a bed. Cost: that of relaxation.
StageEnd pour(SpheresInBed& in_bed, Reporter& report, const BedTop& top,
              const std::shared_ptr<const Container>& whole, const Heights& heights, Laying& how);

/// The spheres that stand there fall and roll to rest before others come. Spheres at rest then stay where
/// they are when others come.
StageEnd rest_first(Bed& bed, const Reporter& report, const Vector<3>& down, double still);

}  // namespace bernal
