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

/// Relative growth of a periodic box of D <= 8 dimensions that outweighs the rounding of its coordinates,
/// when it grows by the largest s / d of a pair, s being the sum of radii and d the distance, and then has
/// the longest edge L; `slenderness` is L over the smallest radius.
///
/// In roundoffs, on each axis: the two centres are off by at most 2 L each after `resize_box`, the edge
/// between images by L, and the difference of which d was found by L. All axes together: 6 sqrt(D) L <= 17 L.
/// Squares, sum, root, quotient and product add D/2 + 6 <= 10 relative to s. Relative to s, which is at least
/// twice the smallest radius r, and with L >= 2 r: 17 L / 2 r + 10 <= 13.5 L / r. This is a little more than
/// twice that.
inline double growth(double slenderness) { return 32 * roundoff * slenderness; }

}  // namespace bernal::tolerance
