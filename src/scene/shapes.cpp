#include "bernal/scene/shapes.hpp"

#include <cstddef>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

Revolved checked(Revolved solid) {
  require_profile(solid);
  return solid;
}

/// Whether the heights rise from each point to the next.
bool rises(const std::vector<Vector<2>>& line, double sign) {
  for (std::size_t k = 1; k < line.size(); ++k)
    if (!(sign * line[k][1] > sign * line[k - 1][1])) return false;
  return true;
}

}  // namespace

Revolved solid_of(const Cone& cone) {
  if (cone.radii.size() != 2 || !(cone.radii[0] + cone.radii[1] > 0))
    throw Error(ErrorCode::bad_argument, "a cone needs two radii, at its base and at its top, not both 0");
  return checked({.base = cone.base,
                  .axis = cone.axis,
                  .profile = {{0, 0}, {cone.radii[0], 0}, {cone.radii[1], cone.height}, {0, cone.height}}});
}

Revolved solid_of(const Tube& tube) {
  if (!(tube.inner_radius < tube.radius))
    throw Error(ErrorCode::bad_argument,
                fmt::format("a tube needs an inner radius below its radius of {}", tube.radius));
  const double in = tube.inner_radius, out = tube.radius, top = tube.height;
  return checked(
      {.base = tube.base, .axis = tube.axis, .profile = {{in, 0}, {out, 0}, {out, top}, {in, top}}});
}

Revolved solid_of(const Lathed& lathed) {
  Revolved solid{.base = lathed.base, .axis = lathed.axis};
  if (!lathed.profile.empty()) solid.profile = lathed.profile.front();
  auto& line = solid.profile;
  if (line.size() >= 2) {
    const bool is_wall = rises(line, 1) || rises(line, -1);
    const bool begins = line.front()[0] == 0, ends = line.back()[0] == 0;
    if (!begins && (is_wall || ends)) line.insert(line.begin(), {0, line.front()[1]});
    if (!ends && (is_wall || begins)) line.push_back({0, line.back()[1]});
  }
  return checked(std::move(solid));
}

}  // namespace bernal
