#include "stages/insert.hpp"

namespace bernal {

std::size_t insert(Bed& bed, Supply& supply, const InsertOptions& options, Random& random,
                   const Monitor& monitor) {
  const Bounds<3> bounds = bed.container().bounds();
  // Trials are counted inside the container, of which its bounds are a multiple.
  const double attempts = options.attempts * std::max(1.0, bounds.volume() / bed.container().volume());
  const std::size_t before = bed.size();
  std::size_t waiting = 0;  // how many at the head of the window found no place
  while (!supply.exhausted() && waiting < supply.window().size() &&
         bed.packing_fraction() < options.packing_fraction && !monitor.stop()) {
    const std::uint32_t tag = supply.window()[waiting];
    const double r = supply.radius(tag);
    bool placed = false;
    for (double trial = 0; trial < attempts && !placed; ++trial) {
      const Vector<3> c = uniform_point(random, bounds);
      if (!bed.fits(c, r)) continue;
      bed.insert(c, r, tag);
      supply.take(waiting);
      placed = true;
    }
    if (!placed) ++waiting;
    if (bed.size() % 1024 == 0) {
      monitor.report({"insert", bed.packing_fraction() / options.packing_fraction});
    }
  }
  return bed.size() - before;
}

}  // namespace bernal
