#include "plan/part_below.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "cad/repair/plane_cut.hpp"

namespace bernal {
namespace {

[[noreturn]] void refuse_plane(std::string_view what) {
  throw Error(ErrorCode::bad_argument,
              fmt::format("{}; give the container as a mesh, which any plane cuts", what));
}

/// The line of an axis that the plane cuts: the points below are those with t <= `at`, or t >= `at`.
struct Crossing {
  double at;
  bool below;
};

/// Of base + t · direction, a unit vector. Nothing where the plane is not across it, to rounding.
std::optional<Crossing> crossing_of(const Vector<3>& base, const Vector<3>& direction,
                                    const Vector<3>& normal, double offset) {
  constexpr double rounding = 1e-12;
  const double along = normal.dot(direction);
  if (normal.cross(direction).norm() > rounding * normal.norm()) return {};
  return Crossing{(offset - normal.dot(base)) / along, along > 0};
}

/// The part of a profile with z <= `at`, or z >= `at`.
std::vector<Vector<2>> cut_profile(const std::vector<Vector<2>>& profile, const Crossing& crossing) {
  const auto height = [&](const Vector<2>& p) {
    return crossing.below ? p[1] - crossing.at : crossing.at - p[1];
  };
  std::vector<Vector<2>> part;
  const auto add = [&](const Vector<2>& p) {
    if (part.empty() || (p != part.back() && p != part.front())) part.push_back(p);
  };
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const Vector<2>&a = profile[k], &b = profile[(k + 1) % profile.size()];
    const double at_a = height(a), at_b = height(b);
    if (at_a <= 0) add(a);
    if (at_a * at_b < 0) add({a[0] + (b[0] - a[0]) * (at_a / (at_a - at_b)), crossing.at});
  }
  return part;
}

struct CutDomain {
  const Vector<3>& normal;
  double offset;

  std::optional<Domain> operator()(const Box& box) const {
    int axis = -1;
    for (int k = 0; k < 3; ++k)
      if (std::abs(normal[k]) == normal.norm()) axis = k;
    if (axis < 0) refuse_plane("a box is cut along x, y or z");
    const double at = offset / normal[axis], lower = box.corner[axis], upper = lower + box.size[axis];
    const bool below = normal[axis] > 0;
    if (below ? at <= lower : at >= upper) return {};
    if (below ? at >= upper : at <= lower) return box;
    Box part = box;
    if (below) {
      part.size[axis] = at - lower;
    } else {
      part.corner[axis] = at;
      part.size[axis] = upper - at;
    }
    if (box.repeats(axis)) part.periodic[static_cast<std::size_t>(axis)] = false;
    return part;
  }
  std::optional<Domain> operator()(const Cylinder& cylinder) const {
    const Vector<3> direction = cylinder.axis.normalized();
    const auto crossing = crossing_of(cylinder.base, direction, normal, offset);
    if (!crossing) refuse_plane("a cylinder is cut across its axis");
    const auto [at, below] = *crossing;
    if (below ? at <= 0 : at >= cylinder.height) return {};
    if (below ? at >= cylinder.height : at <= 0) return cylinder;
    Cylinder part = cylinder;
    part.periodic = false;
    if (below) {
      part.height = at;
    } else {
      part.base += at * direction;
      part.height -= at;
    }
    return part;
  }
  std::optional<Domain> operator()(const Revolved& revolved) const {
    const auto crossing = crossing_of(revolved.base, revolved.axis.normalized(), normal, offset);
    if (!crossing) refuse_plane("a solid of revolution is cut across its axis");
    Revolved part = revolved;
    part.profile = cut_profile(revolved.profile, *crossing);
    if (part.profile.size() < 3) return {};
    try {
      require_profile(part);
    } catch (const Error&) {
      refuse_plane("the plane cuts the profile into several pieces");
    }
    return part;
  }
  std::optional<Domain> operator()(const Mesh& mesh) const {
    require_closed_walls(mesh, "a part cut by a plane");
    constexpr double tolerance = 1e-12;  // of the diagonal: a corner so near to the plane lies on it
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const Vector<3>& v : mesh.vertices) {
      lowest = std::min(lowest, normal.dot(v) - offset);
      highest = std::max(highest, normal.dot(v) - offset);
    }
    const double near = tolerance * bounds_of(Domain(mesh)).size().norm() * normal.norm();
    if (lowest >= -near) return {};
    if (highest <= near) return mesh;
    return cad::cut(mesh, {.normal = normal, .offset = offset, .text = "its place"}, near / normal.norm());
  }
  std::optional<Domain> operator()(const Sphere&) const { refuse_plane("no plane cuts a sphere here"); }
  std::optional<Domain> operator()(const Polygon&) const {
    throw Error(ErrorCode::bad_argument, "no plane cuts a polygon");
  }
};

}  // namespace

std::optional<Domain> part_below(const Domain& domain, const Vector<3>& normal, double offset) {
  return std::visit(CutDomain{normal, offset}, domain);
}

}  // namespace bernal
