#include <algorithm>
#include <cmath>

#include "core/every_dimension.hpp"
#include "soft/published_loop.hpp"
#include "soft/relax.hpp"

namespace bernal {

template <int D>
StageEnd relax_by_the_book(Spheres<D>& spheres, Vector<D>& edges, Work& work, const Relax& options) {
  PublishedLoop<D> loop(spheres, edges, options.settle, work.random(Stream::relax));
  const int sweeps = sweeps_a_cycle(options, spheres.size());
  double reported = 0, molr = 0;
  int sweep = 0;
  std::uint64_t all_sweeps = 0;
  const Resumable part(work, "published loop",
                       [&](Archive& a) { a(reported, molr, sweep, all_sweeps, work.edges, loop); });
  const auto end = [&](StageEnd how) {
    loop.write_to(spheres);
    edges = loop.edges();
    work.effects["relaxation"].calls += all_sweeps;
    return how;
  };
  for (;;) {
    for (; sweep < sweeps; ++sweep) {
      if (work.stop()) return end(StageEnd::cancelled);
      molr = loop.sweep();
      ++all_sweeps;
    }
    sweep = 0;
    if (molr < options.stop) return end(StageEnd::converged);
    loop.grow(1 + molr / options.beta);
    const double done = std::log(molr) / std::log(options.stop);
    if (done < reported) continue;
    reported = done + 0.005;
    work.edges = loop.edges();
    work.milestone("relax", std::clamp(done, 0.0, 0.99), molr);
  }
}

#define BERNAL_INSTANTIATE(D) \
  template StageEnd relax_by_the_book<D>(Spheres<D>&, Vector<D>&, Work&, const Relax&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
