#pragma once

namespace bernal {

/// Which surfaces of a packing a triangle file holds.
enum class SurfaceChoice {
  spheres,    ///< the spheres, seen from outside; cut and closed at the ends of periods
  container,  ///< the container, or a period's boundary, seen from outside
  all,        ///< both
  pores,      ///< the boundary of the pore space, oriented away from the pores: one closed surface
};

}  // namespace bernal
