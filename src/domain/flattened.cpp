#include "domain/flattened.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "bernal/core/error.hpp"
#include "core/rounding.hpp"
#include "geometry/changes.hpp"

namespace bernal {
namespace {

/// A ball has an odd number of rings, and corners are turned by a quarter step, so that level and upright
/// planes through the middle, and those that touch a round wall, meet no corner and no side.
constexpr int sides_of_round = 256, sides_of_ball = 126;
constexpr double quarter_turn = 0.25;

/// How much farther from the axis the corners of a regular polygon are than its sides.
double corners_over_sides(int sides) { return 1 / std::cos(std::numbers::pi / sides); }

struct Flatten {
  RoundAs as;

  Flattened operator()(const Box& box) const {
    const bool within = as == RoundAs::within;
    Bounds<3> bounds{box.corner, box.corner};
    for (int k = 0; k < 3; ++k)
      bounds.upper[k] =
          within ? sum_rounded_down(box.corner[k], box.size[k]) : sum_rounded_up(box.corner[k], box.size[k]);
    return {mesh_of_box(bounds)};
  }

  Flattened operator()(const Cylinder& s) const {
    return (*this)(Revolved{s.base, s.axis, {{0, 0}, {s.radius, 0}, {s.radius, s.height}, {0, s.height}}});
  }

  /// A polygon of as many sides that turns about its diagonal.
  Flattened operator()(const Sphere& ball) const {
    const double factor = corners_over_sides(sides_of_ball);
    const double radius = ball.radius * (as == RoundAs::circumscribed ? factor : 1);
    constexpr int rings = sides_of_ball / 2;
    Revolved solid{.base = ball.center};
    for (int k = 0; k <= rings; ++k) {
      const double angle = std::numbers::pi * k / rings;
      const bool is_pole = k == 0 || k == rings;
      solid.profile.emplace_back(is_pole ? 0 : radius * std::sin(angle), -radius * std::cos(angle));
    }
    return {surface_of(solid, sides_of_ball, as, quarter_turn), ball.radius * (factor * factor - 1)};
  }

  Flattened operator()(const Revolved& solid) const {
    double farthest = 0;
    for (const Vector<2>& p : solid.profile) farthest = std::max(farthest, p[0]);
    return {surface_of(solid, sides_of_round, as, quarter_turn),
            farthest * (corners_over_sides(sides_of_round) - 1)};
  }

  Flattened operator()(Mesh mesh) const {
    mesh.exact = nullptr;
    mesh.surface = nullptr;
    return {std::move(mesh)};
  }

  Flattened operator()(const Polygon&) const {
    throw Error(ErrorCode::bad_argument, "a polygon has no surface");
  }
};

}  // namespace

Flattened flattened(const Domain& solid, RoundAs as) { return std::visit(Flatten{as}, solid); }

}  // namespace bernal
