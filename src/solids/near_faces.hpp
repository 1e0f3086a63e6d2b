#pragma once
#include <span>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "solids/solids.hpp"

namespace bernal {

/// How far a point is from the faces, edges and corners of a part or a period that cuts spheres. A mesh is
/// poor where a sphere is nearly touched: between two surfaces that nearly meet, and in the sharp edge of a
/// low cap.
class NearFaces {
 public:
  /// The lowest cap that a face cuts off, in radii: the edge of a lower one is sharper than 20 degrees.
  static constexpr double least_cap = 0.06;
  /// The least distance from a face that cuts nothing off, in radii.
  static constexpr double least_distance = 0.03;

  /// Bounds at infinity are no faces.
  NearFaces(const Bounds<3>& box, const Vector<3>& point);
  NearFaces(const ConvexPart&, const Vector<3>& point);

  /// The largest radius, up to the given one, with which a sphere around the point reaches beyond each of
  /// them by at least `least_cap`, or is at least `least_distance` away from it; both are at least `gap`, in
  /// radii. At edges sharper than a right angle both are more, since circles in the two faces come near each
  /// other before such an edge and cross at a small angle beyond it. `share`: of both that is enough at
  /// faces. Cost: O(1).
  double clear_radius(double radius, double gap, double share = 1) const;
  /// The same for a sphere and, from the outside in, for the spheres in it in which layers begin; no layer
  /// loses a share of its thickness. `layers`: radii that ascend. False if nothing changed.
  bool clear(double& radius, std::span<double> layers, double gap, double share = 1) const;

 private:
  struct Feature {
    double distance;
    bool is_face;
    double lowest = least_cap, nearest = least_distance;
  };
  std::vector<Feature> features_;
};

/// Makes those spheres and layers smaller that the ends of the periods nearly touch, and states it in
/// `contacts` and `cleared`. Where contacts are not gaps, spheres keep theirs: a third of the clearance is
/// enough at faces, and those that stand on walls, numbered in ascending order, stay as they are.
/// Precondition: centres are in the period; no pieces are made yet. Cost: O(N).
void clear_of_ends(Solids&, double gap, const std::vector<WallFoot>& feet);

}  // namespace bernal
