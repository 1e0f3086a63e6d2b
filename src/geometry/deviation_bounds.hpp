#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/geometry/mesh.hpp"
#include "bernal/geometry/true_surface.hpp"

namespace bernal {

/// Sets the bounds of every face that has any, as `geometry/curved_patch.hpp` proves them: `apart` is at most
/// a tenth more than the distances that occur, apart from slacks and rounding; `track` and `apart` more.
/// Cost: ten to some hundred points of the surface a piece, most for the pieces that deviate most. In
/// threads.
void set_deviation_bounds(TrueSurface&);

/// Leaves the faces whose flat triangles are triangles of the mesh, turned as there. False if these are not
/// all triangles of the mesh, or a face is there in part. Cost: O(n log n).
bool restrict_to(TrueSurface&, const Mesh&);

/// Replaces every point by a linear function of it, which makes all lengths so many times as long. Tolerances
/// are rounded up.
template <class Linear>
void move_linearly(TrueSurface& surface, const Linear& to, double longer) {
  const auto lengthen = [&](double& x) {
    if (longer != 1 && x > 0) x = std::nextafter(longer * x, std::numeric_limits<double>::infinity());
  };
  for (TrueSurface::Piece& piece : surface.pieces) lengthen(piece.slack);
  for (TrueSurface::Face& face : surface.faces) lengthen(face.tolerance);
  for (TrueSurface::Patch& patch : surface.patches) {
    if (auto* swept = std::get_if<TrueSurface::Swept>(&patch)) {
      for (auto& row : swept->c)
        for (Vector<3>& term : row) term = to(term);
    } else {
      for (auto& p : std::get<TrueSurface::Bezier>(patch).points) {
        const Vector<3> moved = to(Vector<3>(p[0], p[1], p[2]));
        std::copy_n(moved.data(), 3, p.begin());
      }
    }
  }
  for (TrueSurface::Flat& flat : surface.flats)
    for (Vector<3>& corner : flat.corners) corner = to(corner);
}

}  // namespace bernal
