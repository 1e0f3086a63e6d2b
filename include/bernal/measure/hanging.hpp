#pragma once
#include <cstdint>
#include <memory>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Spheres that hang, of a bed that was pressed along a direction: with all others held, each of them can
/// move along it by more than `least_fall` of its radius and meets nothing, no sphere and no wall. A wall
/// that is upright, to the sine `upright` of its angle with the direction, supports nothing: it leads past,
/// but for several that together leave no way down.
///
/// A sphere that does not hang may still roll, and a bed of which none hangs need not be in equilibrium.
struct Hanging {
  static constexpr double least_fall = 0.01;  ///< in radii
  static constexpr double upright = 1e-5;

  std::uint64_t spheres = 0;  ///< how many hang
  /// The longest way that one of them could fall, straight, until it meets a sphere or a wall; in the
  /// domain's unit. 0 where none hangs.
  double farthest = 0;
};

/// Of spheres that keep `gap` from each other and `wall_gap` from walls those that these hold do not hang,
/// see `measure_contacts_across`. By a search of its own, which shares neither lists nor kernels with what
/// moves spheres.
///
/// Cost: O(N log N), about 2 µs a sphere, in threads, and a question to the walls for those near them; any
/// size ratio. `made`: see `local_container`. Precondition: spheres of the domain's dimension, 2 or 3, inside
/// it; `direction` of any length but 0, across the axes that repeat themselves, of two dimensions in the
/// plane z = 0.
Hanging measure_hanging(const Spheres<dynamic>&, const Domain&, const Vector<3>& direction, double gap = 0,
                        double wall_gap = 0, const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
