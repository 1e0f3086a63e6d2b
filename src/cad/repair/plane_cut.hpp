#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// A plane normal · p = offset and the side that stays: normal · p <= offset, unless the side is open.
struct CutPlane {
  Vector<3> normal = Vector<3>::UnitZ();
  double offset = 0;
  bool side_is_open = false;  ///< "=": the side that the plane closes
  std::string text = {};

  double height(const Vector<3>& p) const { return normal.dot(p) - offset; }
  /// The same plane with the other side kept.
  CutPlane turned() const;
};

/// "z = 1.1", "x < 0.5", "0.6 x + 0.8 z > 2": a sum of multiples of x, y and z, one of = < >, a number.
/// Throws Error{bad_argument} for anything else.
CutPlane plane_in(std::string_view text);

/// The part of a surface on the plane's side, closed in the plane. Corners within `tolerance` of the plane
/// count as on it. Edges that are open elsewhere stay open. A closed surface entirely on that side is
/// unchanged; of several bodies that it passes between, those on that side stay. Throws Error{bad_mesh} if
/// nothing is on that side, if the plane cuts nothing of an open surface, or if the cut crosses itself. Cost:
/// O(n log n).
Mesh cut(const Mesh& mesh, const CutPlane& plane, double tolerance);

}  // namespace bernal::cad
