#pragma once
#include <optional>

#include "bernal/domain/container.hpp"

namespace bernal {

/// A point where the centre of a sphere may be, and its clearance, or a lower bound of that.
struct Place {
  Vector<3> point;
  double clearance;
};

/// The places of spheres of radius r in a container: the points whose clearance is r, or less by a
/// ten-thousandth of r, which keeps a tube as wide as the spheres from having none but its axis.
class FreeSpace {
 public:
  FreeSpace(const Container& container, double r) : container_(container), r_(r) {}

  const Container& container() const { return container_; }
  double radius() const { return r_; }
  bool is_place(double clearance) const { return clearance >= (1 - slack) * r_; }

  /// About the place nearest to p, if it is at most `limit` away and p inside; for a wedge of planes it is
  /// the nearest one. The planes in which a ball of radius r touches the wall are found one after the other,
  /// from the wall's nearest point, and the nearest point beyond all of them is tried next. Where the wall
  /// bulges inwards the planes cut off places: the place found is then farther than need be. Cost: two
  /// searches for the nearest wall a plane.
  std::optional<Place> nearest(const Vector<3>& p, double limit) const;

  /// Whether a line of places leads from one place to the other, near the straight one. Sure where the
  /// balls a.clearance - r and b.clearance - r meet, as clearance is 1-Lipschitz; else the line is halved at
  /// the place nearest to its middle, down to pieces of length `step`, of which a neck may be closer than r
  /// by step² / 8r where it is sharp. After so many pieces that the line must be very long for r, as through
  /// the cells of a plate, pieces of length `coarse` will do.
  bool joined(const Place& a, const Place& b, double step, double coarse) const;

 private:
  bool joined(const Place& a, const Place& b, double step, double coarse, int& pieces) const;
  static constexpr double slack = 1e-4;

  const Container& container_;
  double r_;
};

}  // namespace bernal
