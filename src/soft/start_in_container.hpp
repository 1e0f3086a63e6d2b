#pragma once
#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/soft/relax.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// The first of the drawn sequence, those in the bed or of the start where they are and the others at random:
/// as many as are asked for, or a few more than are likely to fit without an exchange of sizes. All are
/// larger by `larger_by`.
Spheres<3> spheres_to_start_from(const SpheresInBed&, const Relax&, double larger_by, Random&,
                                 const Monitor&);

}  // namespace bernal
