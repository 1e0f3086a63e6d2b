#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "settle/mover.hpp"
#include "settle/steepest_way.hpp"

namespace bernal {

/// Lets the spheres of a bed fall and roll to rest, one at a time, while all others are held.
///
/// A sphere falls along the direction to first contact. Then it rolls without friction: in the plane of one
/// contact or along the line of two, in whichever leads down most, by steps that Newton's method puts back
/// onto these contacts, until it meets the next obstacle, loses one of them, or nothing leads down that is
/// steeper than `level`. There it rests: what holds it is closed to a gap of a skin.
///
/// Invariant: every gap stays at or above skin/2, and no way leads out of the sphere's bounding box.
/// Precondition: as of `Mover`. Cost: a pass over the neighbours and near walls a step, some ten steps a
/// sphere that falls far, one for a sphere at rest.
class Roller {
 public:
  /// The sine of what counts as level.
  static constexpr double level = 1e-7;

  /// With friction, an angle in degrees, a sphere that touches something rests where nothing leads down more
  /// steeply than that.
  Roller(Bed& bed, const Vector<3>& direction, double friction = 0)
      : bed_(bed),
        mover_(bed),
        down_(direction),
        flattest_(std::max(level, std::sin(friction * std::numbers::pi / 180))) {}

  /// Returns how far sphere i then is from where it was. It rests there, or its bounding box ended.
  double roll(Bed::Id i);

 private:
  using Obstacle = std::uint32_t;  // neighbours first, then walls

  /// An obstacle that the sphere touches.
  struct Contact {
    Obstacle obstacle;
    double gap;
  };
  /// What the sphere stays in contact with on its way, one or two, and where that leads first.
  struct Track {
    std::array<Obstacle, 2> on{};
    int count = 0;
    Vector<3> along = Vector<3>::Zero();  // unit

    bool is_on(Obstacle k) const { return (count > 0 && k == on[0]) || (count > 1 && k == on[1]); }
  };
  struct Nearest {
    double gap;
    Obstacle obstacle;
  };

  Vector<3> from_obstacle(Obstacle, const Vector<3>& offset, double& gap) const;
  double gap_to(Obstacle, const Vector<3>& offset) const;
  void find_contacts();
  Track steepest() const;
  bool put_back(const Track&, Vector<3>& offset) const;
  bool at(const Track&, double t, Vector<3>& offset) const;
  Nearest violated(const Track&, const Vector<3>& offset) const;
  double least_allowed(Obstacle) const;
  double slope(const Track&, const Vector<3>& offset) const;
  double to_lowest(const Track&, double t, Vector<3>& offset) const;
  bool step_along(const Track&, double& step);
  double until_contact(const Track&, double t, Obstacle, Vector<3>& offset) const;
  double longest_on(const Track&) const;
  double room_in_box(const Vector<3>& u) const;
  bool is_in_box(const Vector<3>& offset) const;

  Bed& bed_;
  Mover mover_;
  Vector<3> down_;
  double flattest_;  // sine of the steepest way that is not taken
  std::vector<Contact> contacts_;
  std::vector<Vector<3>> normals_;  // of these, unit, from the obstacle to the sphere
  static constexpr Obstacle none = ~Obstacle{0};
  Obstacle stopper_ = none;                     // what ended the step before at once,
  std::size_t stopper_at_ = SteepestWay::none;  // and where it stands among the contacts
};

}  // namespace bernal
