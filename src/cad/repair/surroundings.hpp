#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "cad/repair/plane_cut.hpp"
#include "cad/triangle_tree.hpp"

namespace bernal::cad {

class SurfacePieces;

/// A space that is closed, and free of the solid.
struct Space {
  Mesh walls;  ///< and those of what stands in it; not yet turned outward
  double volume = 0;
};

/// The space around a solid, in a box that is larger than it: what planes close off from that box is hollow.
class Surroundings {
 public:
  /// Precondition: closed. The solid is copied.
  explicit Surroundings(const Mesh& solid);

  /// What the planes close off, the largest first; of that only what is around a point where there is one.
  /// Planes that leave anything open close off nothing. `least`: what is smaller is passed over. Throws as
  /// `cut`. Cost: that of cutting, of 2 queries in a tree for each piece, and looking for crossings.
  std::vector<Space> closed_off(const std::vector<CutPlane>& planes, double tolerance, double least = 0,
                                const Vector<3>* point = nullptr) const;

  /// Below this volume it is a mere crevice.
  double crevice() const { return 1e-4 * box_.volume(); }
  const TriangleTree& solid() const { return tree_of_solid_; }

 private:
  bool is_on_box(const Vector<3>& p) const;
  bool is_solid(const SurfacePieces&, std::uint32_t piece, const Mesh&) const;

  Mesh walls_;
  Bounds<3> box_;
  TriangleTree tree_of_solid_;
};

/// All of them as one surface.
Mesh walls_of(const std::vector<Space>&);

}  // namespace bernal::cad
