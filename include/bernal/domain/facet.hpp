#pragma once
#include <cstdint>

#include "bernal/core/vector.hpp"

namespace bernal {

/// One smooth piece of a container's wall, as plain data: what a moving sphere has to know of it.
///
/// | kind     | a                | b                  | c      | radius | signed distance of p |
/// |----------|------------------|--------------------|--------|--------|----------------------|
/// | plane    | a point          | inward unit normal |        |        | (p - a)·b            |
/// | cylinder | a point of the axis | unit axis       |        | R      | R - |p - a|⊥b        |
/// | sphere   | centre           |                    |        | R      | R - |p - a|          |
/// | triangle | vertex           | vertex             | vertex | R      | |p - triangle| - R, negative only
/// within R |
///
/// | frustum  | a point of the axis | unit axis       | (r, s, h) | R   | |p - piece| - R, negative only
/// within R |
///
/// A frustum is what the edge of a profile from (r, 0) to (s, h) is about its axis: a piece of a cone, of a
/// cylinder from inside or from outside, a ring or a disc. A triangle without area, two of whose vertices are
/// one, is a segment: an edge of a polygon. Its R is how far inside of it the wall stands, see `Mesh::inset`;
/// 0 for most, and negative where it stands behind.
struct Facet {
  using ArchivedAsBytes = void;
  enum class Kind : std::uint8_t { plane, cylinder, sphere, triangle, frustum };
  Kind kind = Kind::plane;
  std::uint32_t id = 0;  ///< which facet of its container
  Vector<3> a = Vector<3>::Zero();
  Vector<3> b = Vector<3>::Zero();
  Vector<3> c = Vector<3>::Zero();
  double radius = 0;
};

/// Whether the nearest point may lie on a border of the piece: a triangle or a frustum.
constexpr bool has_border(Facet::Kind kind) {
  return kind == Facet::Kind::triangle || kind == Facet::Kind::frustum;
}

/// A facet and its distance from the point that asked.
struct NearFacet {
  double distance;
  Facet facet;
};

/// Distance of p from the facet, signed as the table above says.
double distance(const Facet&, const Vector<3>& p);

/// The point of the facet nearest to p. On an axis or at a centre, where it is not unique, any one of them.
Vector<3> closest_point(const Facet&, const Vector<3>& p);

/// How far a sphere of radius r at c may move along the unit vector `direction`, at most `limit`, so that its
/// distance from the facet stops at r + skin; invariant: it never falls below r + skin/2 if it was not below
/// at the start; if it was, the answer is 0 unless the distance grows.
double first_contact(const Facet&, const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                     double skin);

}  // namespace bernal
