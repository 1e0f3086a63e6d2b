#pragma once
#include <algorithm>
#include <cmath>

#include "neighbors/cell_grid.hpp"

namespace bernal {

/// How near a sphere is: the squared distance of its centre, or of the nearest image of that, and its radius.
struct Nearby {
  double squared_distance, r;
};

/// The radius, at most `limit`, of the largest sphere at p that stays `skin` away from all that the grid
/// holds; any value below `enough` where it is below that. Negative inside of a sphere. `nearby(id)` says how
/// near a sphere is to p. Cost: that of a query of the grid or two.
template <int D, class LookAt>
double room_between_spheres(const CellGrid<D>& grid, const Vector<D>& p, double enough, double limit,
                            double skin, LookAt&& nearby) {
  double room = limit;
  const auto lower = [&](double reach) {
    return grid.any_near(p, reach + skin, [&](typename CellGrid<D>::Id id) {
      const auto [squared, r] = nearby(id);
      const double touching = room + r + skin;
      if (touching > 0 && squared < touching * touching) room = std::sqrt(squared) - r - skin;
      return room < enough;
    });
  };
  // Most places are inside some sphere: look near by before looking far around.
  if (!lower(std::max(0.0, enough))) lower(room);
  return room;
}

}  // namespace bernal
