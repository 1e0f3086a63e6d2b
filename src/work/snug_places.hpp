#pragma once
#include <limits>
#include <optional>

#include "core/archive.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// Places in the bed for spheres that the walls leave hardly any room, which random places do not find: in a
/// slab or a tube as thick as a sphere, in a cube of its own size.
///
/// From random places a sphere is moved away from what is nearest until it is clear of everything, and then
/// along the container to where it touches, so that it leaves the room beside it to others. One that only
/// fits touching the walls, where no place is clear of them by the skin, gets a place that is exact in the
/// scene's own coordinates; no stage moves it from there, as every way leads nearer to a wall.
class SnugPlaces {
 public:
  SnugPlaces(SpheresInBed& in_bed, Reporter& report);

  /// Whether, of some hundred random places, none clears the wall for that radius.
  bool needed(double r);
  /// Cost: about a millisecond.
  std::optional<Vector<3>> find(double r);

  /// Whether all that there is fits only touching the walls.
  bool all_touch();
  /// Moves each sphere that stands nearly between the walls to where it touches them exactly, as far as such
  /// a place is near; the others stay. Takes everything out of the bed.
  void move_to_touch(Spheres<3>& spheres);

  /// Whether of what is asked for some, but not all, fit only touching the walls, and nothing stands yet.
  bool only_some_touch();
  /// Gives these their places, the largest first, before others stand there. Throws Cancelled.
  void place_those_that_touch();

  /// Gives places to those of the window that need such ones, until that packing fraction is there. Returns
  /// how many found one. Throws Cancelled.
  std::size_t place_waiting(double packing_fraction);
  /// The same; where all sizes need such places and some still wait, all start anew if more find one then.
  void complete(double packing_fraction);

  /// What it has found out.
  void archive(Archive& a) { a(random_, roomy_, tight_); }

 private:
  /// `touching`: only what touches the walls exactly.
  std::optional<Vector<3>> from(const Vector<3>& start, double r, bool touching) const;
  std::optional<Vector<3>> from(const Vector<3>& start, double r) const;

  SpheresInBed& in_bed_;

  Reporter& report_;
  Random random_;
  Vector<3> along_;                                         // the container
  double roomy_ = 0;                                        // radii up to this have places by chance
  double tight_ = std::numeric_limits<double>::infinity();  // and from this on they have not
};

}  // namespace bernal
