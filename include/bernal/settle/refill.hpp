#pragma once
#include "bernal/settle/shake.hpp"

namespace bernal {

/// The remaining spheres are put into the free space, all are compressed and shaken, and so on until the
/// container is full or the target is reached (Han, Feng & Owen 2005, section 2).
struct Refill {
  double probes = 15;  ///< random positions to try, per sphere that would fill the container's volume
  int max_rounds = 200;
  double patience = 3e-3;       ///< full when a round adds less than this share of the present volume
  Shake shake = {.rounds = 1};  ///< between two rounds; its compression also follows every refilling
};

}  // namespace bernal
