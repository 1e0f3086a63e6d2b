#include "work/random_insertion.hpp"

#include <algorithm>

#include "bernal/domain/domain.hpp"
#include "core/every_dimension.hpp"

namespace bernal {

template <int D>
void place_at_random(Spheres<D>& spheres, const Vector<D>& edges, Random& random, std::size_t first) {
  const Bounds<D> box{Vector<D>::Zero(), edges};
  for (std::size_t i = first; i < spheres.size(); ++i) spheres.set_center(i, uniform_point(random, box));
}

template <int D>
void displace_at_random(Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls,
                        double length, Random& random, const Tilt& tilt) {
  const TiltedBoundary<D> boundary = tilted_boundary_of<D>(periodic_box(edges, walls, tilt));
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    Vector<D> c = boundary.wrap(spheres.center(i) + length * uniform_direction<D>(random));
    for (int k = 0; k < D; ++k)
      if (!boundary.repeats(k)) c[k] = std::clamp(c[k], 0.0, edges[k]);
    spheres.set_center(i, c);
  }
}

#define BERNAL_INSTANTIATE(D)                                                                                \
  template void place_at_random(Spheres<D>&, const Vector<D>&, Random&, std::size_t);                        \
  template void displace_at_random(Spheres<D>&, const Vector<D>&, const std::vector<bool>&, double, Random&, \
                                   const Tilt&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
