#include <cmath>

#include "core/every_dimension.hpp"
#include "soft/published_loop.hpp"
#include "soft/relax.hpp"

namespace bernal {

template <int D>
StageEnd relax_by_the_book(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                           const Relax& options) {
  PublishedLoop<D> loop(spheres, edges, options.settle, report.random(Stream::relax));
  const int sweeps = sweeps_a_cycle(options, spheres.size());
  double reported = 0, molr = 0;
  int sweep = 0;
  std::uint64_t all_sweeps = 0;
  const Resumable part(report, "published loop",
                       [&](Archive& a) { a(reported, molr, sweep, all_sweeps, in_box.edges, loop); });
  const auto end = [&](StageEnd how) {
    loop.write_to(spheres);
    edges = loop.edges();
    report.effects["relaxation"].calls += all_sweeps;
    return how;
  };
  for (;;) {
    for (; sweep < sweeps; ++sweep) {
      if (report.stop()) return end(StageEnd::cancelled);
      molr = loop.sweep();
      ++all_sweeps;
    }
    sweep = 0;
    if (molr < options.stop) return end(StageEnd::converged);
    loop.grow(1 + molr / options.beta);
    const double done = std::log(molr) / std::log(options.stop);
    if (done < reported) continue;
    reported = done + 0.005;
    in_box.edges = loop.edges();
    report.milestone("relax", in_box, molr, done);
  }
}

#define BERNAL_INSTANTIATE(D) \
  template StageEnd relax_by_the_book<D>(Spheres<D>&, Vector<D>&, SpheresInBox&, Reporter&, const Relax&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
