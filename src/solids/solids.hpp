#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solids/contacts.hpp"
#include "solids/convex_part.hpp"
#include "solids/pieces.hpp"

namespace bernal {

/// A neck between two spheres: the part of a cylinder about the line of their centres outside both.
struct Bridge {
  std::array<std::uint32_t, 2> spheres = {};
  std::array<Vector<3>, 2> rims = {};  ///< centres of the circles in which the cylinder meets the spheres
  double radius = 0;
  std::vector<Cut> cuts = {};  ///< at the ends of the periods

  /// How far the cylinder reaches beyond its middle along an axis.
  double reach_along(int axis) const;
};

/// Spheres within spheres, with the same centres, in which layers begin: radii that ascend, by sphere.
struct InnerSpheres {
  std::vector<std::size_t> first = {};  ///< one entry a sphere, and one more, or none without any
  std::vector<double> radius = {};

  std::span<const double> of(std::size_t sphere) const {
    if (first.empty()) return {};
    return {radius.data() + first[sphere], radius.data() + first[sphere + 1]};
  }
  std::span<double> of(std::size_t sphere) {
    if (first.empty()) return {};
    return {radius.data() + first[sphere], radius.data() + first[sphere + 1]};
  }
};

/// InnerSpheres of spheres that have other radii now.
InnerSpheres scaled(InnerSpheres, const Spheres<dynamic>& before, const Spheres<dynamic>& after);

/// The solids for a mesher: each once, cut at the ends of the periods.
struct Solids {
  Spheres<dynamic> spheres{};  ///< after shrinking, if any; centres in the period
  Domain domain;               ///< its periods begin where cuts do least harm, see `with_clear_ends`
  std::vector<Piece> pieces;
  std::vector<Bridge> bridges;
  ContactReport contacts;
  /// Distance between the ends of the periods and the spheres that they nearly touch, over the radius;
  /// infinite without periods.
  double end_distance = 0;
  double bridge_radius = 0;  ///< as asked for, over the radius of the smaller sphere
  double bridge_angle = 0;   ///< or so, as SolidsOptions
  InnerSpheres shells = {};  ///< which shrink as their spheres do
  /// Of a part cut out of a packing: the domain, without periods, whose faces cut spheres.
  std::optional<ConvexPart> part = {};
  std::size_t cleared = 0;  ///< spheres that are smaller for being nearly touched by an end or a cut

  bool is_cut() const { return part.has_value(); }
};

struct SolidsOptions {
  ContactTreatment contact = ContactTreatment::none;
  double gap = 0.01;
  double bridge_radius = 0.2;
  /// Degrees, instead of the radius: the least half-angle under which spheres see the circles where bridges
  /// begin. 0: none.
  double bridge_angle = 0;
  InnerSpheres shells = {};
  bool clear_of_ends = false;  ///< of periods: see `clear_of_ends`
};

/// Prepares spheres for a mesher. Proven, in exact arithmetic on the given doubles: for gap and shrink what
/// `shrink_contacts` states; for caps that the half-spaces of both spheres of a pair are (ri + rj) gap apart,
/// in all images. Spheres without caps are farther from each other than the gap. Meetings of bridges with
/// third spheres and with each other are found in double.
///
/// cap: for spheres closer than the gap, caps with heights in the ratio of their radii, which leave (ri + rj)
/// gap between the flat faces; at walls they leave r gap. bridge: between spheres closer than the gap; of a
/// fillet the cylinder in it.
///
/// Precondition: three dimensions, diameters not above the periods. Throws Error{bad_argument}, Cancelled.
/// Cost: O(N).
Solids solids_of(const Spheres<dynamic>&, const Domain&, const SolidsOptions&, const Monitor& monitor = {});

/// Where a bridge stands on a wall beside a sphere.
struct WallFoot {
  std::uint32_t sphere;
  double radius;
};

/// The domain with the ends of its periods where no sphere nearly touches them: no face, edge or corner of
/// the box a sphere (relative to the radius), no face a bridge. On each axis the candidates are the middles
/// of the widest gaps between extents, past feet of bridges if there is such a place; the best combination is
/// taken. The spheres do not move; `wrap` moves their centres into the period. Deterministic. Cost:
/// O(N log N) and some million distances, in proportion to the square of `most`, the places tried on an axis.
struct ClearEnds {
  Domain domain;
  double distance;  ///< least, over the radius; infinite without periods
};
ClearEnds with_clear_ends(const Spheres<dynamic>&, const Domain&, const std::vector<Bridge>& bridges = {},
                          const std::vector<WallFoot>& feet = {});

/// Volume of a spherical cap, π h² (3 r - h) / 3.
double cap_volume(double radius, double height);

/// The axis through the poles of a sphere's surface and the direction of its seam meridian: CAD kernels give
/// spheres these edges, and a cut that nearly touches them makes slivers.
struct Seam {
  Vector<3> pole = Vector<3>::UnitZ();
  Vector<3> meridian = Vector<3>::UnitX();  ///< perpendicular to the pole
};
/// A seam that crosses the planes as steeply, and stays as far from their intersections, as the best of 200
/// random ones. Planes are in radii from the centre: normal and distance. The same planes give the same seam.
Seam seam_clear_of(const std::vector<HalfSpace>& planes);
/// One for each piece, the same for all pieces of a sphere, so that opposite ends match.
std::vector<Seam> seams_of(const Solids&);

}  // namespace bernal
