#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Whether the spheres of a bed rest under gravity.
///
/// A sphere *rests* if, with all others fixed, it can neither fall nor roll down without friction: the
/// normals of its contacts, to a gap of `closed`, leave no direction that descends more steeply than `level`.
/// It *hangs* if it does not rest and can move along gravity, past upright walls, by more than `least_fall`
/// without meeting anything. *Friction* of an angle holds a sphere whose steepest way down is no steeper than
/// that angle. This is weaker than balance of forces in the whole bed: each sphere is tested alone, and the
/// load from above is ignored.
struct Rest {
  static constexpr double closed = 1e-6;      ///< gap of a contact, in radii of the tested sphere; larger if
                                              ///< coordinates are too coarse for it
  static constexpr double level = 1e-6;       ///< sine of the steepest slope that counts as level
  static constexpr double least_fall = 0.01;  ///< in radii
  /// Sine of the angle between gravity and a wall that supports nothing.
  static constexpr double upright = 1e-5;

  std::uint64_t hanging = 0;
  std::uint64_t unsettled = 0;  ///< spheres that neither rest nor are held by friction, hanging ones included
  std::uint64_t held_by_friction = 0;
  /// The angle of friction that holds all of them, in degrees: the steepest of their slopes; 0 if there are
  /// none.
  double friction = 0;
  /// The longest straight fall of a hanging sphere to the next sphere or wall, in the domain's unit; 0 if
  /// none hangs.
  double farthest = 0;

  /// A sphere that does not rest: the sine of its steepest slope and, if it hangs, the length of its straight
  /// fall, else 0.
  struct Restless {
    std::uint64_t sphere;
    double slope, fall;
  };
  /// Filled if a list was requested: sorted by fall, then by slope, the largest first.
  std::vector<Restless> list = {};
};

struct RestOptions {
  /// Gaps that the spheres keep from each other and from walls; contacts are across them.
  double gap = 0, wall_gap = 0;
  /// Tolerance of contacts in radii, and of slopes as a sine; at least `Rest::closed` and `Rest::level`. Set
  /// it to about twice the error of rounded coordinates over the radius. Anything nearer then supports a
  /// sphere, so that one that hangs by less, or can roll by less, counts as resting.
  double tolerance = Rest::closed;
  double friction = 0;  ///< largest angle of friction, in degrees
  bool list = false;
};

/// The search is independent of the lists and kernels that move spheres.
///
/// Cost: O(N log N), about 4 µs a sphere, in threads, plus a wall query for spheres near walls; any size
/// ratio. `made`: as `MeasureOptions::container`. Precondition: spheres of the domain's dimension, 2 or 3,
/// inside it; `direction` not 0, in two dimensions in the plane z = 0. Throws Error{bad_argument} for a
/// domain that is periodic along the direction or has no walls.
Rest measure_rest(const Spheres<dynamic>&, const Domain&, const Vector<3>& direction, const RestOptions& = {},
                  const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
