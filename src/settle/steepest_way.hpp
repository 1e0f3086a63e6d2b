#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The steepest way down of a sphere in contact with others and walls.
struct SteepestWay {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  /// The projection of `down` onto the cone of directions that lead into no contact: its length is the sine
  /// of the slope, 0 if the contacts hold the sphere.
  Vector<3> way;
  std::array<std::size_t, 3> held_by{};  ///< the contacts along which the way leads
  int count = 0;                         ///< their number: 0 in free fall, 3 if they hold the sphere
};

/// For contacts with these unit normals, from the contact to the sphere. If the way along contact `bent`
/// bends into it immediately, the way must lead away from it by a millionth, or along it.
///
/// The way is the shortest of all u = down + sum of p_c n_c with pushes p_c >= 0, of which at most three are
/// positive. Found by the algorithm of Lawson and Hanson (1974) for least squares with non-negative unknowns:
/// the contact that u leads into most begins to push; one whose push becomes negative stops. Cost: O(n) a
/// contact that pushes.
SteepestWay steepest_way(const Vector<3>& down, std::span<const Vector<3>> normals,
                         std::size_t bent = SteepestWay::none);

}  // namespace bernal
