#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Whether the spheres of a bed rest, under gravity along a direction.
///
/// A sphere *rests* if, with all others held, it can neither fall nor roll down without friction: of what it
/// touches, to a gap of `closed`, the normals leave no direction that descends more steeply than `level`. It
/// *hangs* if it does not rest and can move along the direction of gravity, past walls that are upright, by
/// more than `least_fall` and meets nothing. *Friction* of an angle holds a sphere whose steepest way down
/// descends by no more than that angle. Balance of forces in the whole bed is more than rest: each
/// sphere is asked alone, and what bears on it from above is held.
struct Rest {
  static constexpr double closed = 1e-6;      ///< gap of a contact, in radii of the sphere that is asked;
                                              ///< more where coordinates are too coarse for it
  static constexpr double level = 1e-6;       ///< sine of the steepest way that counts as none
  static constexpr double least_fall = 0.01;  ///< in radii
  static constexpr double upright = 1e-5;     ///< sine of a wall's angle with gravity that supports nothing

  std::uint64_t hanging = 0;
  std::uint64_t unsettled = 0;  ///< those that neither rest nor are held by friction, hanging ones among them
  std::uint64_t held_by_friction = 0;
  /// The angle of friction that holds them all, in degrees: that of the steepest of their ways. 0 of none.
  double friction = 0;
  /// The longest way that one that hangs could fall, straight, until it meets a sphere or a wall; in the
  /// domain's unit. 0 where none hangs.
  double farthest = 0;

  /// One that does not rest: by how steep a way it can go down, as a sine, and where it hangs, how far it
  /// could fall, straight; else 0.
  struct Restless {
    std::uint64_t sphere;
    double slope, fall;
  };
  /// Where a list was asked for: all of them, those that could fall the farthest first, then those that could
  /// roll the most steeply.
  std::vector<Restless> list = {};
};

struct RestOptions {
  double gap = 0, wall_gap = 0;  ///< that spheres keep from each other and from walls, and that hold them
  /// What counts as touching, in radii, and as level, as a sine: at least `Rest::closed` and `Rest::level`.
  /// More is for coordinates that were rounded, to about twice their error over the radius. What is nearer
  /// then supports as if it touched, so that a sphere which hangs by less, or can roll by less, is taken for
  /// one at rest.
  double tolerance = Rest::closed;
  double friction = 0;  ///< the angle up to which it may hold a sphere, in degrees
  bool list = false;
};

/// By a search of its own, which shares neither lists nor kernels with what moves spheres.
///
/// Cost: O(N log N), about 4 µs a sphere, in threads, and a question to the walls for those near them; any
/// size ratio. `made`: see `local_container`. Precondition: spheres of the domain's dimension, 2 or 3, inside
/// it; `direction` of any length but 0, of two dimensions in the plane z = 0. Throws Error{bad_argument} for
/// a domain that repeats itself along it, or has no walls.
Rest measure_rest(const Spheres<dynamic>&, const Domain&, const Vector<3>& direction,
                  const RestOptions& = {}, const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
