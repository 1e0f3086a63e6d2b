#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "surfaces/icosphere.hpp"

namespace bernal {

/// A plane normal·p = offset about the centre of a ball, and the kind of face it makes.
struct BallPlane {
  Vector<3> normal;
  double offset;
  int face;  ///< Cut::face
};

/// A polyhedron inscribed in a ball around the origin, cut by planes one after the other.
///
/// Both halves of a cut have the same polygon in the plane, bit for bit: the crossing of an edge is computed
/// from its ends in a canonical order, and corners move by rules that are independent of the side. Corners
/// near a plane are moved onto it, along the sphere, so that no slivers arise; new corners of a cut are moved
/// out onto the sphere, within their planes. No corner moves across an earlier plane. So every corner lies on
/// the sphere except those where cuts meet inside it, or nearly meet beyond it. A cap lower than `least_cap`
/// is not cut off but pushed in, and its other half is empty.
class CutBall {
 public:
  /// `radius` of the sphere with the corners; the planes must outlive this.
  CutBall(int frequency, double radius, const std::vector<BallPlane>& planes);

  /// Removes what is beyond the plane, where normal·p > offset (`below`), or the other half. False if the cut
  /// does not form closed loops because of rounding.
  bool cut(int plane, bool below);
  bool empty() const { return faces_.empty(); }

  struct Corner {
    Vector<3> place;
    std::array<int, 3> planes = {-1, -1, -1};  ///< planes that it lies on, ascending; -1: no further one
    bool operator==(const Corner&) const = default;
    int count() const;
  };
  struct Face {
    int plane;  ///< -1 for faces on the sphere
    std::vector<std::uint32_t> corners;
  };
  const std::vector<Corner>& corners() const { return corners_; }
  const std::vector<Face>& faces() const { return faces_; }

  /// Triangles of a face, counter-clockwise from outside; those of a cap are the same in both halves.
  std::vector<std::array<std::uint32_t, 3>> triangles_of(const Face& face) const;

 private:
  static double height(const Vector<3>& place, const BallPlane& plane);
  bool may_move(const Corner& from, const Vector<3>& to) const;
  std::optional<Vector<3>> placed(const Corner& corner) const;
  void push_in(const BallPlane& plane, bool below);
  void snap(int plane);
  std::uint32_t crossing(std::uint32_t from, std::uint32_t to, int plane);
  bool close(int plane);

  double radius_, edge_, least_cap_;
  const std::vector<BallPlane>& planes_;
  std::vector<int> done_;  // planes of earlier cuts
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
};

}  // namespace bernal
