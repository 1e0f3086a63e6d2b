#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "cad/repair/plane_cut.hpp"
#include "cad/triangle_tree.hpp"

namespace bernal::cad {

class SurfacePieces;

/// A closed space outside the solid.
struct Space {
  Mesh walls;  ///< including those of what is inside it; not yet oriented outwards
  double volume = 0;
};

/// The space around a solid within a larger box: what planes close off from that box is hollow.
class Surroundings {
 public:
  /// Precondition: closed. The solid is copied.
  explicit Surroundings(const Mesh& solid);

  /// The spaces that the planes close off, the largest first; with `point`, only the one around it. Planes
  /// that leave anything open close off nothing. `least`: smaller spaces are skipped. Throws as `cut`. Cost:
  /// that of cutting, 2 tree queries for each piece, and a search for crossings.
  std::vector<Space> closed_off(const std::vector<CutPlane>& planes, double tolerance, double least = 0,
                                const Vector<3>* point = nullptr) const;

  /// Volumes below this are mere crevices.
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
