#pragma once

namespace bernal {

/// How spheres that touch or nearly touch are prepared for a mesher, which would otherwise need elements
/// without thickness between them.
enum class ContactTreatment {
  none,    ///< they stay as they are
  gap,     ///< spheres closer than the gap to another or to a wall shrink, only as far as needed
  shrink,  ///< all spheres shrink by one factor, until the gap is kept
  bridge,  ///< cylinders join spheres that are closer to each other than the gap
  cap,     ///< caps are cut off where spheres are closer than the gap to each other or to a wall
  fillet,  ///< as bridge, by parts of tori that touch both; in meshes of beds
};

/// Whether spheres nearer than the gap are joined.
constexpr bool joins(ContactTreatment treatment) {
  return treatment == ContactTreatment::bridge || treatment == ContactTreatment::fillet;
}

/// Whether spheres are made smaller until they are the gap apart.
constexpr bool shrinks(ContactTreatment treatment) {
  return treatment == ContactTreatment::gap || treatment == ContactTreatment::shrink;
}

}  // namespace bernal
