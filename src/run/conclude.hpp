#pragma once
#include "bernal/run/packing.hpp"
#include "work/work.hpp"

namespace bernal {

/// How the last stage's end, what stands where, and what the scene asked for make the outcome of the run and
/// the sentence behind it. `meets_expectation`: the last stage places as many spheres as are expected to fit
/// where the scene says nothing. The packing has its spheres already.
void conclude(Packing& packing, const Work& work, StageEnd end, bool meets_expectation);

}  // namespace bernal
