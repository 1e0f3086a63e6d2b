#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/hard/grow.hpp"
#include "core/archive.hpp"
#include "core/event_clock.hpp"
#include "core/large_pages.hpp"
#include "core/made.hpp"
#include "hard/calendar.hpp"
#include "hard/collision_kernels.hpp"
#include "hard/shells.hpp"
#include "hard/walls.hpp"

namespace bernal {

/// Statistics of a period of `HardSpheres`.
struct FlightPeriod {
  using ArchivedAsBytes = void;
  double time = 0;                ///< in units of the caller's length over the thermal speed
  std::uint64_t collisions = 0;   ///< of pairs
  std::uint64_t reflections = 0;  ///< of spheres from walls
  std::uint64_t departures = 0;   ///< of spheres from their shells
  std::uint64_t builds = 0;       ///< of all lists
  std::uint64_t predictions = 0;  ///< scans of all neighbours of a sphere
  std::uint64_t scanned = 0;      ///< neighbours in all of them
  /// P V / N k T at the initial temperature, from the virial theorem: 1 + Σ q b / 2 E t over all exchanged
  /// momenta q, along b: the line of centres of a pair, the radius at a wall. On average it is the pressure
  /// on the walls, but it scatters less.
  double compressibility_factor = 1;
  /// Momentum received by walls, sum of magnitudes: on average P times their area and the time.
  double wall_momentum = 0;
  double heating = 0;    ///< relative growth of the kinetic energy
  bool stopped = false;  ///< the monitor stopped it
};

/// Times of the events of all periods; those of collisions include renewed predictions.
struct FlightTimes {
  using ArchivedAsBytes = void;
  EventClock collisions, reflections, departures;
  double builds = 0;  ///< seconds
};

/// Options of `HardSpheres`.
template <int D>
struct HardSphereOptions {
  /// No sphere leaves the region between them. Precondition: along an axis that they close, the region plus a
  /// largest diameter, at the final size, is no longer than the edge.
  std::vector<Wall<D>> walls = {};
  /// In their place in a container that is not convex; they outlive the spheres.
  const FacetedWalls* facets = nullptr;
  /// Centres keep so many times the given radii away from walls, however large spheres are by then; 0: as far
  /// as their present radii. Precondition: they begin so far away, and grow no larger.
  double room_at_walls = 0;
  Masses masses = Masses::equal;
  const CollisionKernel<D>* kernel = nullptr;  ///< the fastest if absent
};

/// Event-driven dynamics of hard spheres that grow in a periodic box or between walls in it (Lubachevsky &
/// Stillinger; Kansal, Torquato & Stillinger): spheres fly freely until two touch; then they exchange
/// momentum along the line of centres, elastically relative to their growing surfaces, v_n -> 2 s' - v_n for
/// the relative velocity v_n of centres and the growth s' of the sum of radii.
///
/// All radii are the given ones times `size()`, which grows linearly in time, so the size distribution does
/// not change. Lengths are in the caller's unit; the unit of mass is the mean mass m, that of velocity the
/// thermal speed √(k T / m), to which all velocities are rescaled at the start of a period if spheres grow.
/// Each period starts at time zero, which avoids the rounding of long times.
///
/// Invariant: at the end of a period no two spheres overlap by more than rounding, about 1e-15 edges.
/// Precondition: `has_room` at the start of each period; at least one sphere. Cost: for 10,000 equal spheres
/// 0.8 µs a collision in a fluid, 0.5 near jamming; twice that for lognormal sizes of sigma 0.5. For 10^6
/// about 1.5 times as much, 1.9 times with a last-level cache of 3 MB: events occur at random places, so all
/// that they read, about 46 cache lines a collision, comes from memory in spite of prefetching. To spread
/// that over an event, to begin four or eight events ahead, and to note events by weeks before days each gain
/// at most 4 %; fewer lines would be needed. Memory about 350 bytes a sphere. One thread; the
/// same bits on every x86-64.
template <int D>
class HardSpheres {
 public:
  /// Centres in [0, edge), without overlap at size 1 and inside the walls; velocities are drawn uniformly,
  /// without drift unless there are walls or a single sphere: after a few collisions they have Maxwell's
  /// distribution.
  HardSpheres(const Spheres<D>& spheres, const Vector<D>& edges, Random random,
              HardSphereOptions<D> options = {});

  /// Lets the spheres fly for about 16 collisions each, or until they reach the size `largest`, jam, or the
  /// monitor stops. `growth` is that of the mean diameter over the thermal speed.
  FlightPeriod fly(double growth, double largest = std::numeric_limits<double>::infinity(),
                   const Monitor& monitor = {});

  const FlightTimes& times() const { return times_; }

  std::size_t count() const { return spheres_.size(); }
  double size() const { return size_; }
  /// Total over all spheres, in units of m k T / m = 1.
  double kinetic_energy() const;
  /// Centres in [0, edge), in the caller's order; radii do not change.
  void write_to(Spheres<D>& spheres) const;

  /// Least edge of a box in largest diameters, so that no sphere meets two images of a neighbour.
  static constexpr double smallest_edge = 2.5;
  /// Its state between two periods, for an object made with the same number of spheres, radii and walls.
  void archive(Archive& a) {
    a(spheres_, original_, shells_, walls_, size_, growth_, horizon_, freedom_, largest_listed_, times_,
      period_, listed_collisions_, listed_departures_);
  }

  /// Whether the box is still large enough.
  bool has_room() const { return edges_.minCoeff() >= smallest_edge * 2 * largest_radius_ * size_; }

 private:
  /// What walls see of the spheres: the share of their radii, its growth, and the largest that lists allow
  /// for.
  double size_at_walls() const { return room_at_walls_ > 0 ? room_at_walls_ : size_ + growth_ * now_; }
  double growth_at_walls() const { return room_at_walls_ > 0 ? 0 : growth_; }
  double listed_at_walls() const { return std::max(room_at_walls_, largest_listed_); }
  double time_to_touch_wall(std::uint32_t i, double limit) {
    const FlyingSphere<D>& me = spheres_[i];
    return walls_.time_to_touch(i, me.position(now_), me.velocity(), me.r * size_at_walls(),
                                me.r * growth_at_walls(), limit);
  }
  void settle_at_walls(std::uint32_t i, const Vector<D>& home, double freedom) {
    walls_.settle(i, home, spheres_[i].r * listed_at_walls() + freedom);
  }
  using Id = std::uint32_t;
  /// Events other than collisions.
  static constexpr Id look_again = Calendar::none, leave = Calendar::none - 1,
                      touch_wall = Calendar::none - 2;
  static bool is_partner(Id what) { return what < touch_wall; }

  double duration(double growth, double largest) const;
  double wanted_freedom() const;
  void sort_along_curve();
  void build_shells(double freedom, double largest);
  void prefetch();
  void predict(Id i);
  void schedule(Id i, double time, Id what) {
    calendar_.schedule(i, time, what);
    spheres_[i].event = time;
  }
  /// Whether i and its partner still expect to collide with each other: the other may have found an earlier
  /// event.
  bool is_mutual(Id i, Id partner) const {
    return calendar_.what(partner) == i && calendar_.time(partner) == calendar_.time(i);
  }
  double time_to_leave(Id i) const;
  void collide(Id i, Id j);
  void reflect(Id i);
  void rescale_velocities();
  double mass(double r) const {
    if (density_ == 0) return 1;
    double mass = density_;
    for (int k = 0; k < D; ++k) mass *= r;
    return mass;
  }

  EventClock& clock_of(Id what) {
    return what == leave ? times_.departures : what == touch_wall ? times_.reflections : times_.collisions;
  }

  const Made made_{"growth"};
  LargePageVector<FlyingSphere<D>> spheres_;
  std::vector<Id> original_;  // index of each in the caller's order
  Vector<D> edges_;
  CollisionKernel<D> kernel_;
  Shells<D> shells_;
  Calendar calendar_;
  CollisionScan<D> scan_{};
  std::vector<double> scratch_;
  Walls<D> walls_;
  double room_at_walls_;

  double mean_diameter_, largest_radius_;  // at size 1
  double density_ = 0;                     // mass over radius to the power D; 0: all masses are 1
  double size_ = 1;
  double growth_ = 0;  // of the size, a unit of time
  double horizon_ = 0;
  double freedom_;             // radius of the shells
  double largest_listed_ = 0;  // size up to which the lists hold
  double now_ = 0;
  std::size_t prefetched_day_ = 0, prefetched_ = 0;  // that day's events up to this one were prefetched

  FlightTimes times_;
  FlightPeriod period_;                                          // the last or current one
  double virial_ = 0;                                            // sum over the period's collisions
  std::uint64_t listed_collisions_ = 0, listed_departures_ = 0;  // since the lists were built
};

}  // namespace bernal
