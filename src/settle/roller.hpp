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

/// Lets the spheres of a bed fall and roll to rest, one at a time, with all others fixed.
///
/// A sphere falls along the direction to first contact. Then it rolls without friction: in the plane of one
/// contact or along the line of two, whichever descends most, by steps that Newton's method puts back onto
/// these contacts, until it meets the next obstacle, loses a contact, or no way is steeper than `level`.
/// There it rests: the contacts that hold it are closed to a gap of a skin.
///
/// Invariant: every gap stays at or above skin/2, and the sphere stays in its bounding box. Precondition: as
/// for `Mover`. Cost: a pass over the neighbours and near walls a step, about ten steps for a sphere that
/// falls far, one for a sphere at rest.
/// sphere that falls far, one for a sphere at rest.
class Roller {
 public:
  /// Sine of the steepest slope that counts as level.
  static constexpr double level = 1e-7;

  /// With friction, an angle in degrees, a sphere in contact rests if no way down is steeper than that.
  Roller(Bed& bed, const Vector<3>& direction, double friction = 0)
      : bed_(bed),
        mover_(bed),
        down_(direction),
        flattest_(std::max(level, std::sin(friction * std::numbers::pi / 180))) {}

  /// Returns the displacement of sphere i. It rests there, or its bounding box ended.
  double roll(Bed::Id i);

 private:
  using Obstacle = std::uint32_t;  // neighbours first, then walls

  /// An obstacle that the sphere touches.
  struct Contact {
    Obstacle obstacle;
    double gap;
  };
  /// The one or two contacts that the sphere keeps on its way, and the initial direction.
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
  double flattest_;  // sine of the steepest slope that is not followed
  std::vector<Contact> contacts_;
  std::vector<Vector<3>> normals_;  // of the contacts: unit, from the obstacle to the sphere
  static constexpr Obstacle none = ~Obstacle{0};
  Obstacle stopper_ = none;                     // the obstacle that ended the last step immediately,
  std::size_t stopper_at_ = SteepestWay::none;  // and its index among the contacts
};

}  // namespace bernal
