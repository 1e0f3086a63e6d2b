#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The points p with normal·p <= offset; the normal has unit length.
struct HalfSpace {
  Vector<3> normal = Vector<3>::UnitZ();
  double offset = 0;
};

/// A plane that cuts off a part of a ball.
struct Cut {
  HalfSpace keeps;
  /// The face of the period: 0 and 1 at the lower and upper end of the first axis, up to 5 for the third; or
  /// that of a convex part; or `contact`.
  int face = contact;
  static constexpr int contact = -1;
};

/// The part of a ball in the domain: a sphere or its image without what is beyond its cuts.
struct Piece {
  std::uint32_t sphere = 0;       ///< its index in the packing
  std::array<int, 3> image = {};  ///< displacement along each axis, in periods
  Vector<3> center = Vector<3>::Zero();
  double radius = 0;
  std::vector<Cut> cuts = {};
};

/// Every ball that reaches into the domain, in all its images, cut at the ends of the periods: in the order
/// of the spheres, a whole one or the image in the period first. Balls that only touch an end do not reach
/// beyond it. At opposite ends pieces are cut by equal circles, shifted by the period: centres of images are
/// rounded once, center + image * period. Precondition: three dimensions, centres in the period (`wrap`),
/// diameters not above the period. Cost: O(N).
std::vector<Piece> pieces_of(const Spheres<dynamic>&, const Domain&);

}  // namespace bernal
