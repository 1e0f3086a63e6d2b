#pragma once
#include <array>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// How much of a domain is below a level across the direction of gravity. Heights are those of points along
/// -`down`. The divergence theorem over the facets of its surface, of which those that are upright drop out:
///   V(h) = sum of (projected area) · mean of min(z - h, 0), with z the height on a facet.
/// Exact to rounding for boxes, spheres, meshes and polygons, and for cylinders and solids of revolution that
/// stand upright; those that lean are prisms of a thousand sides and the same volume, to 1e-5, or of fewer
/// where a profile has many edges. What an inset takes away is spread evenly. Along an axis that repeats
/// itself it is one period.
///
/// Cost: O(facets) a level. Precondition: a domain of two or three dimensions; `down` a unit vector, across
/// the axes that repeat themselves, of two dimensions in the plane z = 0.
class VolumeBelow {
 public:
  VolumeBelow(const Domain&, const Vector<3>& down);

  /// Volume, or area, of the points whose height is at most that.
  double operator()(double height) const;
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  struct Slope {
    double area;              // projected along the vertical, positive where the domain is below
    std::array<double, 3> z;  // heights of the corners, ascending
  };
  void add_triangle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c);
  void add_prism(const std::vector<Vector<3>>& base, const Vector<3>& edge);
  void add(const Box&);
  void add(const Cylinder&);
  void add(const Sphere&) {}
  void add(const Mesh&);
  void add(const Polygon&);
  void add(const Revolved&);
  double between_facets(double height) const;

  Vector<3> up_;
  double radius_ = 0;  // of a ball, which has no facets
  double lowest_, highest_;
  double scale_ = 1;
  std::vector<Slope> slopes_;
};

}  // namespace bernal
