#pragma once
#include "bernal/settle/refill.hpp"
#include "settle/shake.hpp"

namespace bernal {

using RefillOptions = Refill;

/// Refilling (Han, Feng & Owen 2005, section 2): spheres still to come are put wherever the free space holds
/// them, the bed is compressed and shaken, and so on until the domain is full or the target is reached.
///
/// In a round, random places are probed for the largest sphere that each of them holds; then the spheres to
/// come, in their order, take the first place that is large enough. Cost: O(1) a probe, and that of the
/// compression.
StageEnd refill(Work& work, const RefillOptions& options);

}  // namespace bernal
