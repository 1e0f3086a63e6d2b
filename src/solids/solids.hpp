#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "solids/contacts.hpp"
#include "solids/pieces.hpp"

namespace bernal {

/// A neck between two spheres: what a cylinder about the line of their centres has outside of both.
struct Bridge {
  std::array<std::uint32_t, 2> spheres = {};
  std::array<Vector<3>, 2> rims = {};  ///< the centres of the circles in which the cylinder meets the spheres
  double radius = 0;
  std::vector<Cut> cuts = {};  ///< at the ends of the periods

  /// How far the cylinder reaches beyond its middle along an axis.
  double reach_along(int axis) const;
};

/// What meshers are given: every solid once, cut at the ends of the periods.
struct Solids {
  Spheres<dynamic> spheres{};  ///< as they are after a treatment that shrinks, centres in the period
  Domain domain;               ///< its periods begin where cuts spoil least, see `with_clear_ends`
  std::vector<Piece> pieces;
  std::vector<Bridge> bridges;
  ContactReport contacts;
  /// Between the ends of the periods and the spheres that they nearly touch, over the radius; infinite where
  /// nothing repeats itself.
  double end_distance = 0;
};

struct SolidsOptions {
  ContactTreatment contact = ContactTreatment::none;
  double gap = 0.01;
  double bridge_radius = 0.2;
  bool move_ends = true;  ///< whether the periods may begin elsewhere
};

/// Takes spheres apart for a mesher. What is proven, in exact arithmetic, about the doubles as they are:
/// gap and shrink what `shrink_contacts` says; of caps that the half spaces that hold both of a pair lie
/// (ri + rj) gap apart, in all their images. Wherever no cap has been cut off, spheres are farther from each
/// other than the gap. Bridges are told from third spheres and from each other in double.
///
/// cap: of spheres nearer than the gap, caps of heights in the ratio of their radii, so that between the flat
/// faces (ri + rj) gap is left; at walls, so that r gap is left to the wall. bridge: between spheres nearer
/// than the gap.
///
/// Precondition: three dimensions, diameters not above the periods. Throws Error{bad_argument}, Cancelled.
/// Cost: O(N).
Solids solids_of(const Spheres<dynamic>&, const Domain&, const SolidsOptions&, const Monitor& monitor = {});

/// The domain with the ends of its periods where no sphere nearly touches them: no face of the box a sphere,
/// no edge, no corner, over the radius; no face a bridge. On each axis in the middle of one of the widest
/// gaps between what begins and ends there; of those the best together. The spheres stay where they are;
/// `wrap` moves their centres into the period. Deterministic. Cost: O(N log N) and some million distances.
struct ClearEnds {
  Domain domain;
  double distance;  ///< least, over the radius; infinite where there is no period
};
ClearEnds with_clear_ends(const Spheres<dynamic>&, const Domain&, const std::vector<Bridge>& bridges = {});

/// Volume of a ball between its cuts at the ends of periods, to some roundoffs of the ball's volume; cuts of
/// contacts are left out.
double volume_between_ends(const Piece&);
/// Volume of a spherical cap, π h² (3 r - h) / 3.
double cap_volume(double radius, double height);

/// An axis through the poles and the direction, seen from it, of the meridian where a sphere's surface begins
/// anew: kernels of CAD give spheres these three edges, and a cut that nearly touches them makes slivers.
struct Seam {
  Vector<3> pole = Vector<3>::UnitZ();
  Vector<3> meridian = Vector<3>::UnitX();  ///< perpendicular to the pole
};
/// A seam that crosses the planes as steeply, and stays as far from where two of them cross, as the best of
/// 200 random ones does. Planes are given in radii, from the centre: normal and distance. The same planes
/// give the same seam.
Seam seam_clear_of(const std::vector<HalfSpace>& planes);
/// One a piece, the same for all pieces of a sphere, so that what opposite ends cut off is alike.
std::vector<Seam> seams_of(const Solids&);

}  // namespace bernal
