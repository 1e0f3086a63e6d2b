#pragma once
#include <optional>
#include <span>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The true surface that triangles of a patch stand for.
struct RoundSurface {
  enum class Kind {
    flat,      ///< as the triangles are
    plane,     ///< through `center`, with `axis` as its normal
    sphere,    ///< about `center`
    cylinder,  ///< about the line through `center` along `axis`
    torus,     ///< of a tube about the circle of that radius around `axis`, in the plane through `center`
  };
  Kind kind = Kind::flat;
  Vector<3> center = Vector<3>::Zero();
  Vector<3> axis = Vector<3>::UnitZ();  ///< unit length
  double radius = 0;
  double tube = 0;  ///< of a torus: the radius of its tube
  /// Of a torus that a round wall bends: heights above `from` are scaled by 1 - rise / height, where the wall
  /// rises by R - sqrt(R² - x²) at the distance x along `across`, or from the axis where that is zero.
  struct Bend {
    double wall_radius = 0;  ///< 0: none
    Vector<3> across = Vector<3>::Zero();
    double from = 0, height = 0;
  };
  Bend bend = {};

  bool is_round() const { return kind != Kind::flat && kind != Kind::plane; }
};

/// The signed distance of a point from a surface that is not flat, and the direction in which it grows, of
/// unit length; zero where that is not defined: at centres and on axes.
struct DistanceFrom {
  double distance = 0;
  Vector<3> direction = Vector<3>::Zero();
};
DistanceFrom distance_from(const RoundSurface&, const Vector<3>&);

/// The point near the given one that lies on all of the surfaces, by Newton's method with the shortest steps:
/// the nearest one for one sphere, plane or cylinder, to second order in the distance for others. Nothing
/// where it does not get there within 1e-12 of their radii. None of the surfaces is flat. Cost: about 1 µs.
std::optional<Vector<3>> point_on_all(std::span<const RoundSurface>, const Vector<3>& near);

}  // namespace bernal
