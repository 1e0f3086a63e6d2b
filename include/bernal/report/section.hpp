#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// A plane through a packing of three dimensions: the points p with normal · p = offset. It is looked at with
/// `right` and `up`, unit vectors in it: +z points up unless the plane lies across it.
struct SectionPlane {
  Vector<3> normal = Vector<3>::UnitY();  ///< of unit length
  double offset = 0;
  Vector<3> right = Vector<3>::UnitX();
  Vector<3> up = Vector<3>::UnitZ();
  std::string text = {};  ///< "y = 1.5"
};

/// The plane of "y = 1.5" or "0.6 x + 0.8 z = 2". Throws Error{bad_argument} for anything else.
SectionPlane section_plane(std::string_view text);

/// The plane through the middle of the domain's bounds: y = const, where what settles along z is seen from
/// the side, z = const where a domain has no walls, x = const where only those across y are walls. Where
/// a mesh has no surface there, as between two parts, the plane through the middle of its widest facet.
/// Precondition: three dimensions.
SectionPlane middle_plane(const Domain&);

/// What a plane cuts of spheres and their domain.
struct Section {
  struct Circle {
    Vector<2> center;  ///< along `right` and `up`, in the scene's unit
    double radius;     ///< sqrt(r² - h²) of a sphere of radius r whose centre is h from the plane
    std::size_t sphere;
    bool sticks_out = false;  ///< of one period
  };
  SectionPlane plane;
  std::vector<Circle> circles;  ///< in the order of the spheres; images that reach into the domain are others
  /// Of the domain or of one period of it: closed lines whose inside is the domain's by the even-odd rule.
  /// That of a box or mesh is exact to rounding; a round one has its points on the curve, which it leaves by
  /// at most 1e-5 of its radius.
  std::vector<std::vector<Vector<2>>> outline;
  double area = 0;          ///< that the outline encloses
  double covered_area = 0;  ///< of it, by circles; what two of them cover counts twice
  double area_fraction() const { return covered_area / area; }
};

/// Precondition: three dimensions. A plane in a face cuts that face. Throws Error{bad_argument} where the
/// plane does not meet the domain. Cost: O(N + T) for T triangles, in oblique planes of periodic domains
/// more.
Section section_of(const Spheres<dynamic>&, const Domain&, const SectionPlane&);

/// A picture of the section: exact circles, coloured by the radii of the spheres as `packing.svg` is, the
/// outline, the plane and its area fraction.
std::string section_svg(const Section&, const Spheres<dynamic>&, std::string_view unit);

}  // namespace bernal
