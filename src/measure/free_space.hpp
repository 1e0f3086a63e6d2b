#pragma once
#include <optional>

#include "bernal/domain/container.hpp"

namespace bernal {

/// A possible centre of a sphere, with its clearance or a lower bound of it.
struct Place {
  Vector<3> point;
  double clearance;
};

/// The places of spheres of radius r in a container: the points with clearance of at least r, less a
/// ten-thousandth of r, without which a tube as wide as the spheres would have places only on its axis.
class FreeSpace {
 public:
  FreeSpace(const Container& container, double r) : container_(container), r_(r) {}

  const Container& container() const { return container_; }
  double radius() const { return r_; }
  bool is_place(double clearance) const { return clearance >= (1 - slack) * r_; }

  /// Approximately the nearest place to p, if at most `limit` away, for p inside; exactly the nearest for a
  /// wedge of planes. The planes in which a ball of radius r touches the wall are found one by one, starting
  /// at the wall's nearest point; each time the nearest point beyond all of them is tried next. If the wall
  /// bulges inwards, planes exclude some places, and the result is farther than necessary. Cost: two
  /// nearest-wall searches a plane.
  std::optional<Place> nearest(const Vector<3>& p, double limit) const;

  /// Whether a chain of places leads from one place to the other, near the straight line. Certain if the
  /// balls of radius a.clearance - r and b.clearance - r meet, as clearance is 1-Lipschitz; else the line is
  /// bisected at the place nearest to its middle, down to pieces of length `step`, within which a sharp neck
  /// may be narrower than r by step² / 8r. After many pieces, when the line is very long compared with r (as
  /// in a plate), pieces of length `coarse` suffice.
  bool joined(const Place& a, const Place& b, double step, double coarse) const;

 private:
  bool joined(const Place& a, const Place& b, double step, double coarse, int& pieces) const;
  static constexpr double slack = 1e-4;

  const Container& container_;
  double r_;
};

}  // namespace bernal
