#include "domain/revolved_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace bernal {
namespace {

/// A corner of the profile, its r multiplied; a corner between an outer and an inner wall may become two.
std::vector<Vector<2>> profile_with(const Revolved& shape, double outer, double inner) {
  double twice = 0;
  const auto& corners = shape.profile;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector<2>&a = corners[k], &b = corners[(k + 1) % corners.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  std::vector<Vector<2>> made;
  const auto add = [&](const Vector<2>& p) {
    if (made.empty() || made.back() != p) made.push_back(p);
  };
  const std::size_t n = corners.size();
  const auto factor = [&](std::size_t k) {  // of the edge from corner k on; 0: level, any will do
    const double rise = corners[(k + 1) % n][1] - corners[k % n][1];
    return rise == 0 ? 0.0 : (rise > 0) == (twice > 0) ? outer : inner;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const double before = factor((k + n - 1) % n), after = factor(k);
    for (const double f : {before, after}) {
      const double used = f != 0 ? f : before + after != 0 ? std::max(before, after) : outer;
      add({used * corners[k][0], corners[k][1]});
    }
  }
  while (made.size() > 1 && made.back() == made.front()) made.pop_back();
  if (twice < 0) std::ranges::reverse(made);
  return made;
}

}  // namespace

Mesh surface_of(const Revolved& shape, int sides, RoundAs as, double turn) {
  const double step = 2 * std::numbers::pi / sides;
  const double same_area = std::sqrt(step / std::sin(step));
  const double around_sides = 1 / std::cos(0.5 * step);
  const double outer = as == RoundAs::of_same_area    ? same_area
                       : as == RoundAs::circumscribed ? around_sides
                                                      : 1;
  const double inner = as == RoundAs::of_same_area ? same_area : as == RoundAs::within ? around_sides : 1;
  const std::vector<Vector<2>> profile = profile_with(shape, outer, inner);
  const Vector<3> axis = shape.axis.stableNormalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  const auto around = static_cast<std::uint32_t>(sides);
  Mesh mesh;
  std::vector<std::uint32_t> first;  // corner of each ring
  for (const Vector<2>& p : profile) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const Vector<3> center = shape.base + p[1] * axis;
    if (p[0] == 0) {
      mesh.vertices.push_back(center);
      continue;
    }
    for (std::uint32_t k = 0; k < around; ++k) {
      const double angle = (turn + k) * step;
      mesh.vertices.push_back(center + p[0] * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  for (std::size_t k = 0; k < profile.size(); ++k) {
    const std::size_t next = (k + 1) % profile.size();
    const bool from_axis = profile[k][0] == 0, to_axis = profile[next][0] == 0;
    if (from_axis && to_axis) continue;
    for (std::uint32_t s = 0; s < around; ++s) {
      const std::uint32_t t = (s + 1) % around;
      const auto corner = [&](std::size_t ring, bool on_axis, std::uint32_t side) {
        return first[ring] + (on_axis ? 0 : side);
      };
      // The profile runs counter-clockwise in (r, z): outer walls upwards.
      if (!from_axis)
        mesh.triangles.push_back(
            {corner(k, false, s), corner(k, false, t), corner(next, to_axis, to_axis ? s : t)});
      if (!to_axis)
        mesh.triangles.push_back({corner(k, from_axis, s), corner(next, false, t), corner(next, false, s)});
    }
  }
  mesh.inset = shape.inset;
  return mesh;
}

double sides_for(const Revolved& shape, double deflection) {
  double largest = 0;
  for (const Vector<2>& p : shape.profile) largest = std::max(largest, p[0]);
  if (!(largest > 0)) return 12;
  return std::max(12.0, std::ceil(std::numbers::pi / std::acos(1 / (1 + deflection / largest))));
}

}  // namespace bernal
