#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "surfaces/icosphere.hpp"

namespace bernal {

/// A plane normal·p = offset about the centre of a ball, and the name of what it is.
struct BallPlane {
  Vector<3> normal;
  double offset;
  int face;  ///< Cut::face
};

/// A polyhedron inscribed in a ball around the origin, cut by planes one after the other.
///
/// Both halves of a cut have the same polygon in the plane, bit for bit: where an edge crosses is computed
/// from its ends in an order of their own, and all that is moved is moved by rules that know no side. Corners
/// near a plane are moved onto it, along the sphere, so that no slivers arise; corners that a cut makes are
/// moved out onto the sphere, within their planes. None is moved across a plane that has been cut. So every
/// corner lies on the sphere but those where cuts meet inside it, or nearly meet beyond it. A cap that is
/// less high than `least_cap` is not cut off but pushed in, and its other half is empty.
class CutBall {
 public:
  /// `radius` of the sphere that the corners lie on; the planes outlive this.
  CutBall(int frequency, double radius, const std::vector<BallPlane>& planes);

  /// Takes away what lies beyond the plane, where normal·p > offset (`below`), or the other half. False where
  /// the cut is not one or several closed loops: rounding has the better of it.
  bool cut(int plane, bool below);
  bool empty() const { return faces_.empty(); }

  struct Corner {
    Vector<3> place;
    std::array<int, 3> planes = {-1, -1, -1};  ///< that it lies on, ascending; -1: no further one
    bool operator==(const Corner&) const = default;
    int count() const;
  };
  struct Face {
    int plane;  ///< -1 on the sphere
    std::vector<std::uint32_t> corners;
  };
  const std::vector<Corner>& corners() const { return corners_; }
  const std::vector<Face>& faces() const { return faces_; }

  /// Triangles that fill a face, seen counter-clockwise from outside; those of a cap are the same in both
  /// halves.
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
  std::vector<int> done_;  // planes that it has been cut by
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
};

}  // namespace bernal
