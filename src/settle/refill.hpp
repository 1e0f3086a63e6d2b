#pragma once
#include "settle/shake.hpp"

namespace bernal {

struct RefillOptions {
  int max_rounds = 200;
  double probes = 15;  ///< random places to look at, for each sphere that would fill the container's volume
  double patience = 3e-3;  ///< full when a round adds less volume than this share of what is there
  ShakeOptions shake;      ///< between two rounds; its compression also follows every refilling
};

/// Refilling (Han, Feng & Owen 2005, section 2): spheres still to come are put wherever the free space holds
/// them, the bed is compressed and shaken, and so on until the domain is full or the target is reached.
///
/// In a round, random places are probed for the largest sphere that each of them holds; then the spheres to
/// come, in their order, take the first place that is large enough. Cost: O(1) a probe, and that of the
/// compression.
StageEnd refill(Work& work, const RefillOptions& options);

}  // namespace bernal
