#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The surface of a CAD file by its formulas, and the triangles that stand for it.
///
/// Every face is a map S from a region of parameters (u, v) into space. The region is covered by triangles of
/// parameters, the *pieces*, and every piece belongs to a flat triangle in space.
///
/// Invariants: the flat triangles together are closed; a continuous map, linear on every piece, takes the
/// pieces onto the flat triangles that they belong to; a piece lies in one patch, which is infinitely often
/// differentiable there; whatever point of the face (and of the gaps that the file leaves between faces and
/// at corners) is in no piece's image is within `slack` of one.
struct TrueSurface {
  /// S(u, v) = sum over i, j of c[i][j] b_i(u) b_j(v), with b(s) = (1, s, cos s, sin s): planes, cylinders,
  /// cones, spheres, tori, and whatever a line, circle or ellipse sweeps that is turned or moved along a
  /// line.
  struct Swept {
    using ArchivedAsBytes = void;
    std::array<std::array<Vector<3>, 4>, 4> c = zero();
    static std::array<std::array<Vector<3>, 4>, 4> zero() {
      std::array<std::array<Vector<3>, 4>, 4> all;
      for (auto& row : all) row.fill(Vector<3>::Zero());
      return all;
    }
  };

  /// A rational Bézier patch over the box [lower, upper] of parameters: control point (i, j) is the i-th of
  /// `degree[0] + 1` along u and the j-th of `degree[1] + 1` along v, at i (degree[1] + 1) + j. Points are
  /// homogeneous, (w x, w y, w z, w), with weights w > 0.
  struct Bezier {
    static constexpr int most_degree = 25;

    std::array<int, 2> degree{};
    std::array<double, 2> lower{}, upper{};
    std::vector<std::array<double, 4>> points;
  };

  using Patch = std::variant<Swept, Bezier>;

  /// A triangle of parameters. One without area stands for a curve or a point of the boundary, with the
  /// file's tolerance as its slack.
  struct Piece {
    using ArchivedAsBytes = void;
    std::uint32_t patch = 0, flat = 0;  ///< by index
    std::array<std::array<double, 2>, 3> at{};
    double slack = 0;
  };

  /// A triangle in space, with the orientation of its face.
  struct Flat {
    using ArchivedAsBytes = void;
    std::array<Vector<3>, 3> corners;
    std::uint32_t face = 0;  ///< by index
  };

  struct Face {
    std::uint32_t number = 0;        ///< in the file, from 1
    std::string kind;                ///< "plane", "B-spline", …
    double tolerance = 0;            ///< the largest of its edges and corners
    std::string without_bound = {};  ///< why nothing is proven of it; empty if something is
    /// Proven: the largest distance of a point of the face from the flat triangles. And where nine tenths of
    /// that occur.
    double apart = 0;
    Vector<3> worst = Vector<3>::Zero();
    /// As `apart`, from the flat triangle that the point's piece belongs to.
    double track = 0;
  };

  std::vector<Patch> patches;
  std::vector<Piece> pieces;  ///< in the order of their flat triangles
  std::vector<Flat> flats;    ///< in the order of their faces
  std::vector<Face> faces;

  bool empty() const { return faces.empty(); }
  /// The face with the largest `apart`; precondition: not empty. And the largest of other bounds.
  const Face& worst_face() const { return *std::ranges::max_element(faces, {}, &Face::apart); }
  double largest(double Face::*bound) const {
    double most = 0;
    for (const Face& face : faces) most = std::max(most, face.*bound);
    return most;
  }
};

}  // namespace bernal
