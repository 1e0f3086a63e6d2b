#pragma once

namespace bernal {

/// What becomes of spheres that touch or nearly do before a mesher sees them: between them a mesh would need
/// elements without thickness.
enum class ContactTreatment {
  none,    ///< they stay as they are
  gap,     ///< spheres nearer to another or to a wall than the gap shrink, no more than that takes
  shrink,  ///< all spheres shrink by one factor, until none is nearer than the gap
  bridge,  ///< cylinders join spheres that are nearer to each other than the gap
  cap,     ///< caps are cut off where spheres are nearer to each other or to a wall than the gap
};

}  // namespace bernal
