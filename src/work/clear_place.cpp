#include "work/clear_place.hpp"

namespace bernal {
namespace {

/// Tries to find a place where a sphere clears the wall.
constexpr int tries_clear = 100;
/// And to find one that is inside at all, which of a container's places at least one in a hundred is, and of
/// those that `Places` cannot narrow down one in a thousand.
constexpr int tries_inside = 100000;

}  // namespace

Vector<3> clear_place(double r, const Container& container, const Places& places, Random& random,
                      const Monitor& monitor) {
  if (monitor.stop()) throw Cancelled();
  Vector<3> best = Vector<3>::Zero();
  double most = 0;
  for (int k = 0; k < (most > 0 ? tries_clear : tries_inside); ++k) {
    const Vector<3> p = places.draw(random);
    const double clearance = container.clearance_within(p, r);
    if (clearance > most) {
      most = clearance;
      best = p;
    }
    if (clearance >= r) break;
  }
  return best;
}

}  // namespace bernal
