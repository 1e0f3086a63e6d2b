#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "domain/places.hpp"
#include "near/cell_grid.hpp"

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

/// A place in a container: the radius of the largest sphere that fits there between the others, negative
/// where spheres cover it, and the distance from the wall.
struct Hole {
  Vector<3> place;
  double room, clearance;

  double fitting() const { return std::min(room, clearance); }
};

/// For each of the radii, which descend, the emptiest of `probes` random places that has not been given to
/// one before it: one that clears the wall if there is any. Fewer, if there are not so many places. Cost:
/// about 0.2 µs a probe.
std::vector<Hole> holes_for(std::span<const double> radii, const Container& container, const Places& places,
                            const Spheres<3>& spheres, std::size_t probes, Random& random);

/// Puts some of the spheres of a periodic box into holes between the others: the largest first, each into the
/// next roomiest of so many random places that none of those before it covers by half; at random where there
/// are no more holes. Room is what is left to the nearest surface, which is a wall on axes that have `walls`.
/// Cost: two random places for each sphere in the box and a thousand more, each about 1 µs in three
/// dimensions.
template <int D>
void move_to_holes(Spheres<D>& spheres, const Vector<D>& edges, std::vector<std::uint32_t> ids,
                   Random& random, const std::vector<bool>& walls = {});

}  // namespace bernal
