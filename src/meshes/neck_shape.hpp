#pragma once
#include <array>
#include <cstddef>
#include <optional>

namespace bernal {

/// The side of a neck: a surface of revolution about the line from a sphere's centre to another's or, at
/// right angles, to a wall. Heights are those above the centre of the first sphere.
///
/// A cylinder has its radius everywhere. A fillet is a part of a torus with a tube of radius t about the
/// circle of radius s = radius + t at the height `waist`, seen from outside of the tube: R(h) = s - sqrt(t² -
/// (h - waist)²), tangent to the spheres of radii r1 and r2 at distance d and to a plane at distance D if
///   s² + waist² = (r1 + t)²,  s² + (d - waist)² = (r2 + t)²,  D - waist = t.
struct NeckShape {
  double radius = 0;                    ///< least one
  double begin = 0, end = 0;            ///< heights of the circles in which it begins and ends
  std::array<double, 2> rims = {0, 0};  ///< radii of these
  double tube = 0, waist = 0;           ///< of fillets

  bool is_fillet() const { return tube > 0; }
  double spine() const { return radius + tube; }
  double largest_radius() const { return rims[0] > rims[1] ? rims[0] : rims[1]; }
  /// A circle on the side, by its share of the length of the meridian.
  struct Ring {
    double height, radius;
  };
  Ring ring(double share) const;
  /// Angles of the tube's radius above the plane of its circle where the side begins and ends.
  std::array<double, 2> turns() const;
  /// Length of the meridian.
  double length() const;
  /// Volume between the planes of its two circles, in closed form.
  double volume() const;
};

/// What a neck joins: a sphere of radius `first` and another at this distance of centres, or a flat wall at
/// this distance of the centre. Precondition: no overlap.
struct NeckEnds {
  double first = 0;
  std::optional<double> second = {};
  double distance = 0;

  double least_radius() const { return second && *second < first ? *second : first; }
};

/// Precondition: the radius is below all radii of spheres.
NeckShape cylinder_between(const NeckEnds&, double radius);
/// The fillet whose waist has this radius: t is the root of a quadratic equation. Precondition as above.
NeckShape fillet_between(const NeckEnds&, double radius);
/// The radius, between 0.05 (0.1 of fillets) and 0.7 of the smaller sphere's, with which the circle in which
/// a neck begins is seen from the centres of spheres under half-angles of at least this one, in degrees.
double radius_for_angle(const NeckEnds&, double degrees, bool is_fillet);
/// The largest radius up to the given one with which the fillet's circles on sphere or wall `end` have a
/// radius of at most this one; `radius` itself, if they have. 0: none.
double radius_for_rim(const NeckEnds&, std::size_t end, double rim, double radius);

}  // namespace bernal
