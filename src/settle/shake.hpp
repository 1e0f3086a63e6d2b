#pragma once
#include "bernal/settle/shake.hpp"
#include "settle/compress.hpp"

namespace bernal {

using ShakeOptions = Shake;

/// Shaking (Han, Feng & Owen 2005): arches that hold against the compression direction are broken by
/// iterations in which every sphere moves along a random local direction *perpendicular* to the global one,
/// to first touch and on along its contacts; then the bed is compressed again. Cost: 10 sweeps a round, and
/// those of the compression.
StageEnd shake(Work& work, const ShakeOptions& options);

}  // namespace bernal
