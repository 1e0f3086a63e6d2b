#pragma once
#include <array>
#include <limits>

#include "bernal/domain/container.hpp"
#include "domain/dyadic.hpp"
#include "domain/motion.hpp"

namespace bernal {

// The pieces of the wall of a solid of revolution: what the edge of a profile sweeps over as it turns about
// the axis. In the half plane through the axis and a point p, which has the coordinates r and z there, the
// nearest point of the piece is that of the edge: the distance is that of (r, z) from a segment.

/// An edge of a profile, from a to b, with the doubles that it is given by; the axis is taken as it stands,
/// of whatever length.
struct ProfileEdge {
  Vector<3> base, axis;
  Vector<2> a, b;
};
/// By the doubles of a facet of kind frustum.
ProfileEdge edge_of(const Facet& frustum);
/// The facet of an edge, its end on the axis rounded.
Facet facet_of(const ProfileEdge& edge, std::uint32_t id);

/// The point's r and z about an axis of unit length through `base`.
Vector<2> in_half_plane(const Vector<3>& p, const Vector<3>& base, const Vector<3>& unit_axis);
/// The point of the segment nearest to p.
Vector<2> nearest_of_edge(const Vector<2>& p, const Vector<2>& a, const Vector<2>& b);

/// The way of a point, c + t·direction, seen from a piece; in the 64 bits of long double.
///
/// With w = c - base, r(t)² = |w⊥ + t v⊥|² is a quadratic polynomial and z(t) linear. The point is at the
/// distance R from the piece where it is that from the line of the edge, whose normal is n, with its foot
/// between the ends:  n0 r(t) + n1 z(t) - n·a = ± R, squared a quadratic equation; or from an end (p, q) of
/// it:  r² + p² - 2 p r + (z - q)² = R². There r(t) is convex, so that below a chord of it lies a quadratic
/// polynomial that is nowhere above the left side; the first root of these, with chords that become short,
/// comes to the first root from the left and never passes it.
class FrustumWay {
 public:
  using Real = long double;
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  FrustumWay(const ProfileEdge& edge, const Vector<3>& c, const Vector<3>& direction);

  Real distance(Real t) const;
  /// A bound of the error of `distance`, and of a length that is compared with it.
  Real error(Real t, double r) const;
  /// The first t in [from, limit] from which on the distance is below R, or `never`. A way that comes nearer
  /// than R by less than rounding may count as one that does or does not.
  Real first_below(Real R, Real from, Real limit) const;
  Real speed() const { return speed_; }
  Real lengths() const { return lengths_; }

 private:
  using Point = std::array<Real, 2>;
  using LongVector = Eigen::Matrix<Real, 3, 1>;
  Point at(Real t) const;
  /// When the way comes nearer than R to the line of the edge, and when to the edge itself with its foot
  /// between the ends.
  struct Crossing {
    Real of_line = never, of_edge = never;
  };
  Real line_distance(Real t) const;
  Crossing line_below(Real R, Real from, Real limit) const;
  Real end_below(const Point& end, Real R, Real from, Real limit) const;

  Point a_, e_;  // the first end, and the way to the other
  Real length_;
  Real z_, vz_;        // z(t) = z + vz t
  LongVector p_, v_;   // across the axis, r(t) = |p + t v|
  Real pp_, pv_, vv_;  // its square is pp + 2 pv t + vv t²; for roots, which near the axis are none too good
  Real speed_, lengths_;
};

/// Whether the way, as far as c + limit·direction, is known to keep that distance from the piece because it
/// keeps it from the line of its edge, on the side of the axis, where that distance is concave along the way:
/// its ends tell. In doubles, to some roundoffs of the lengths; most questions in a convex vessel end here.
bool keeps_inside(const ProfileEdge& edge, const Vector<3>& c, const Vector<3>& direction, double limit,
                  double distance);

/// The rule of kernels/first_contact.hpp for a piece.
double first_contact_with_frustum(const ProfileEdge& edge, const Vector<3>& c, double r,
                                  const Vector<3>& direction, double limit, double skin);

/// Whether no point of the piece is nearer to p than r, decided on the doubles as they are. With |a| the
/// length of the axis, |a| r and |a| z are the root of |w × a|² and w·a: each comparison is the sign of a
/// sum of rationals times 1, |w × a|, |a| and their product, which squaring decides. Cost: some 20 µs.
bool clears_exactly(const ProfileEdge& edge, const ExactVector& p, double r);

/// Whether the ray from p away from the axis crosses the edge, whose lower end alone belongs to it.
bool is_crossed_outwards_exactly(const ProfileEdge& edge, const ExactVector& p);

/// The move limit without a skin, see domain/free_path.hpp, at the levels filtered and exact; where a way
/// only grazes the piece, by less than a 2^-60th of the lengths, it may end there.
double free_path(const ProfileEdge& edge, const Motion& motion, WallArithmetic arithmetic);

/// See `first_contact_exactly` in domain/free_path.hpp.
double first_contact_exactly(const ProfileEdge& edge, const Motion& motion, double skin);

}  // namespace bernal
