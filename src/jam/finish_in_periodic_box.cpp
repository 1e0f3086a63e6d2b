#include "jam/finish_in_periodic_box.hpp"

#include <algorithm>

#include "bernal/core/tolerance.hpp"
#include "bernal/domain/boundary.hpp"
#include "core/every_dimension.hpp"
#include "jam/polish.hpp"
#include "work/free_of_overlap.hpp"
#include "work/resize_box.hpp"

namespace bernal {

template <int D>
void shake(Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls, double length,
           Random random) {
  Boundary<D> boundary{edges};
  for (std::size_t k = 0; k < walls.size(); ++k)
    if (walls[k]) boundary.edges[static_cast<int>(k)] = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    Vector<D> c = boundary.wrap(spheres.center(i) + length * uniform_direction<D>(random));
    for (int k = 0; k < D; ++k)
      if (!boundary.repeats(k)) c[k] = std::clamp(c[k], 0.0, edges[k]);
    spheres.set_center(i, c);
  }
}

template <int D>
void free_of_overlap(Spheres<D>& spheres, Vector<D>& edges, Work& work) {
  Vector<D> free = edges_free_of_overlap<D>(spheres, edges, work.allowed_overlap, work.walls);
  while (!free.allFinite()) {  // cancelled while centres coincide
    shake<D>(spheres, edges, work.walls, 1e-3 * std::ranges::max(spheres.r), work.random(Stream::relax));
    free = edges_free_of_overlap<D>(spheres, edges, work.allowed_overlap, work.walls);
  }
  resize_box<D>(spheres, edges, free);
}

template <int D>
bool fits(const Spheres<D>& spheres, const Vector<D>& edges, const Vector<D>& target) {
  const double rounding = tolerance::growth(target.maxCoeff() / std::ranges::min(spheres.r));
  return (target.array() >= edges.array() * (1 + rounding)).all();
}

template <int D>
StageEnd finish_in_periodic_box(Spheres<D> spheres, Vector<D> edges, StageEnd end, double polish_to,
                                Work& work) {
  if (polish_to > 0 && end == StageEnd::converged) {
    end = polish<D>(spheres, edges, polish_to, work).end;
    free_of_overlap<D>(spheres, edges, work);
  }
  work.needed_volume = edges.prod();
  if (work.target_edges && fits<D>(spheres, edges, *work.target_edges))
    resize_box<D>(spheres, edges, *work.target_edges);
  work.spheres = std::move(spheres);
  work.edges = edges;
  work.placed = true;
  return end;
}

#define BERNAL_INSTANTIATE(D)                                                                  \
  template StageEnd finish_in_periodic_box<D>(Spheres<D>, Vector<D>, StageEnd, double, Work&); \
  template void free_of_overlap<D>(Spheres<D>&, Vector<D>&, Work&);                            \
  template bool fits<D>(const Spheres<D>&, const Vector<D>&, const Vector<D>&);                \
  template void shake<D>(Spheres<D>&, const Vector<D>&, const std::vector<bool>&, double, Random);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
