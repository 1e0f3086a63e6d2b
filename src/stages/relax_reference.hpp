#pragma once
#include "stages/relax.hpp"

namespace bernal {

/// The published loop as it stands, in double: the oracle of the fast path. The spheres are moved in place,
/// in the order of their numbers. Precondition: `work.edges` are those of the start.
template <int D>
StageEnd relax_by_the_book(PeriodicWork& work, const RelaxOptions& options);

}  // namespace bernal
