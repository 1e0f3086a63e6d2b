#pragma once
#include <algorithm>
#include <limits>

namespace bernal::tolerance {

/// Unit roundoff of double: one correctly rounded operation has a relative error of at most this.
inline constexpr double roundoff = 0.5 * std::numeric_limits<double>::epsilon();

/// Relative width of the skin around a sphere of radius r; see `skin`.
inline constexpr double relative_skin = 1e-9;

/// The skin: a moving sphere stops when its gap to a neighbour or wall has shrunk to `skin`, and a neighbour
/// or wall whose gap never falls below `skin / 2` on the way does not stop it. So every gap stays at or above
/// skin / 2 for ever, and a sphere that rests on something can still leave it or slide along it.
///
/// `radius` is the sphere's; `resolution` is the largest rounding error of a coordinate (spacing of doubles
/// at the far corner of the domain, in the same unit). A thousand resolutions leave room for the
/// rounding of the few dozen operations of any contact formula in `kernels/` (each at most 8 resolutions
/// at unit condition) and of the final translation into the scene's frame.
inline double skin(double radius, double resolution) {
  return std::max(relative_skin * radius, 1e3 * resolution);
}

/// Relative growth of a periodic box that outweighs the rounding of its coordinates: after centres and edges
/// have been multiplied by a common factor, a distance d of two centres is off by at most three roundings of
/// a coordinate on each axis of each centre and of the edge, 18 roundoffs of the longest edge in three
/// dimensions and 48 in eight. Twice that, of the smallest sum of radii. `slenderness` is the longest edge
/// over the smallest radius.
inline double growth(double slenderness) { return 48 * roundoff * slenderness; }

}  // namespace bernal::tolerance
