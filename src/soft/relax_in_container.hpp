#pragma once
#include "bernal/soft/relax.hpp"
#include "work/work.hpp"

namespace bernal {

using RelaxInContainerOptions = Relax;

/// Random close packing in a container with the sizes as they were drawn.
///
/// As many spheres as the target asks for are put at random places and relaxed: they overlap and push each
/// other and are pushed by the walls, min(omega / n, 1) of the sum of n overlaps at a time (Zhao, Li & Liu
/// 2007, equations 3 and 4, with a fixed container in place of the growing box). Where they get stuck, radii
/// are two per cent larger for fifty sweeps, and every second time the most squeezed spheres are put into the
/// largest holes instead, whatever is between. When that does not help any more, as many of the last of the
/// drawn sequence are taken out as the overlaps suggest: the result is the drawn sequence less its tail.
/// Where the target is to fill the container, more of the sequence are pushed in until even a few find no
/// room.
///
/// Spheres that are there already keep their places at first. All are put back into the bed by the same
/// question as those of any other stage: whether they fit.
///
/// Cost: 300 sweeps where there is room to spare, some thousand where there is not; about 20 ns a sphere and
/// sweep and 50 ns more for one at the wall.
StageEnd relax_in_container(Work& work, const RelaxInContainerOptions& options);

}  // namespace bernal
