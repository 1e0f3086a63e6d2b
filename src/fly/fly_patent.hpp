#pragma once
#include <cstdint>
#include <vector>

#include "bernal/fly/fly.hpp"
#include "core/archive.hpp"
#include "fly/flying_spheres.hpp"
#include "work/reporter.hpp"

namespace bernal {

/// Collision filling as the patent has it ("Modelling of composites filled with hyperspheres in n-dimensional
/// space", Sun, Qian, Shi & Liu, Inner Mongolia Synthetic Chemical Research Institute, 2023, steps 1 to 14):
/// batches of new spheres, from large to small, at random places, those that overlap anything put back;
/// between two batches all fly for a step. If nothing overlaps after the time Δt the step is taken; if
/// exactly one pair does, all fly until those two touch, and they collide elastically; if more do, Δt is
/// halved. Whole arrays of Eigen are moved at once. Centres are reflected at the faces of the box, images
/// cross them.
///
/// Mended: a pair counts once, however many of its images overlap (one at a face would count four times and
/// halve Δt for ever); a pair that rounding leaves overlapping after its collision, and that separates, is
/// none; a centre beyond a face gets the velocity that leads back, where a flip of the sign would chatter; Δt
/// is cut to half the smallest radius, so that nothing tunnels; collisions at the same time happen one after
/// the other, without a move; it ends `full` after `patience` places in vain for each sphere that is wanted.
/// Of new spheres that overlap each other the first stays. Overlaps are looked for in lists of near pairs and
/// not among all pairs, new places in the grid of PartialGrid. A wall is one more thing to collide with.
///
/// A step passes one collision at most, and costs O(N): the time to a packing fraction grows as N² at least.
template <int D>
class PatentFlight {
 public:
  using Id = typename FlyingSpheres<D>::Id;

  PatentFlight(FlyingSpheres<D>& spheres, const Fly& options, Random random);

  /// One batch of new spheres. Returns how many found a place.
  std::size_t insert();
  /// One step of flight.
  void fly() {
    const auto start = EventClock::Clock::now();
    const std::uint64_t before = collisions_;
    step();
    if (collisions_ > before) seconds_of_collisions_ += EventClock::seconds_since(start);
  }
  std::uint64_t collisions() const { return collisions_; }
  /// Of the steps that ended with one.
  double seconds_of_collisions() const { return seconds_of_collisions_; }
  std::uint64_t steps() const { return steps_; }

  /// Its state between two steps, but for the spheres.
  void archive(Archive& a) { a(seconds_of_collisions_, random_, next_, flown_, collisions_, steps_); }

 private:
  void step();
  /// A pair or, if `wall` is not negative, a sphere and the wall of that axis.
  struct Hit {
    Id first, second;
    int wall;
  };

  void turn_back_at_faces();
  /// Up to two that overlap in these places.
  int hits(const typename FlyingSpheres<D>::Columns& x, Hit (&found)[2]) const;
  double time_to(const Hit& hit) const;
  void collide(const Hit& hit);

  const Made made_{"collisions"};
  double seconds_of_collisions_ = 0;
  FlyingSpheres<D>& spheres_;
  std::size_t batch_;
  double dt_;
  Random random_;
  typename FlyingSpheres<D>::Columns next_;
  double flown_ = 0;  // since the pairs were listed
  std::uint64_t collisions_ = 0, steps_ = 0;
};

/// Fills the box `Task::target_edges` that way. As `fill_by_relaxation` otherwise.
StageEnd fly_by_patent(SpheresInBox& in_box, Reporter& report, const Fly& options);

}  // namespace bernal
