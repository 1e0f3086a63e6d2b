#pragma once
#include "bernal/settle/compress.hpp"

namespace bernal {

/// Spheres move across the direction of compression, so that arches break, and are compressed again (Han,
/// Feng & Owen 2005).
struct Shake {
  int rounds = 2;        ///< each: sweeps across the direction, then compression
  double amplitude = 2;  ///< longest way of a sphere in one sweep, in mean radii
  Compress compress = {};
};

}  // namespace bernal
