#pragma once

namespace bernal {

/// What of a packing a file of triangles holds.
enum class SurfaceChoice {
  spheres,    ///< the spheres, seen from outside; cut and closed at the ends of periods
  container,  ///< the container, or a period's boundary, seen from outside
  all,        ///< both
  pores,      ///< the boundary of the pore space, seen from the pores' outside: one closed surface
};

}  // namespace bernal
