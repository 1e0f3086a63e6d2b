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

/// A plane through a packing of three dimensions: the points p with normal · p = offset. `right` and `up` are
/// unit vectors in the plane that orient the picture; +z points up unless it is normal to the plane.
struct SectionPlane {
  Vector<3> normal = Vector<3>::UnitY();  ///< of unit length
  double offset = 0;
  Vector<3> right = Vector<3>::UnitX();
  Vector<3> up = Vector<3>::UnitZ();
  std::string text = {};  ///< "y = 1.5"
};

/// The plane of an equation such as "y = 1.5" or "0.6 x + 0.8 z = 2". Throws Error{bad_argument} for anything
/// else.
SectionPlane section_plane(std::string_view text);

/// The plane through the middle of the domain's bounds: y = const, which shows settling along z from the
/// side; z = const for a domain without walls; x = const if only the y axis has walls. If a mesh has no
/// surface there, as between two parts, the plane goes through the middle of its widest facet. Precondition:
/// three dimensions.
SectionPlane middle_plane(const Domain&);

/// The cut of a plane through spheres and their domain.
struct Section {
  struct Circle {
    Vector<2> center;  ///< along `right` and `up`, in the scene's unit
    double radius;     ///< sqrt(r² - h²) for a sphere of radius r with its centre h from the plane
    std::size_t sphere;
    bool sticks_out = false;  ///< protrudes from the period
  };
  SectionPlane plane;
  /// In the order of the spheres; each image that reaches into the domain has its own.
  std::vector<Circle> circles;
  /// Boundary of the domain, or of one period: closed lines with the inside by the even-odd rule. Exact to
  /// rounding for a box or mesh; a round outline has its points on the curve, from which it departs by at
  /// most 1e-5 of the radius.
  std::vector<std::vector<Vector<2>>> outline;
  double area = 0;          ///< inside the outline
  double covered_area = 0;  ///< of that, inside circles; the overlap of two circles counts twice
  double area_fraction() const { return covered_area / area; }
};

/// Precondition: three dimensions. A plane in a face cuts that face. Throws Error{bad_argument} if the plane
/// does not meet the domain. Cost: O(N + T) for T triangles; more for oblique planes of periodic domains.
Section section_of(const Spheres<dynamic>&, const Domain&, const SectionPlane&);

/// A picture of the section: exact circles in the colours of `packing.svg`, the outline, the plane and its
/// area fraction.
std::string section_svg(const Section&, const Spheres<dynamic>&, std::string_view unit);

}  // namespace bernal
