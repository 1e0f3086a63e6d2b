#include "soft/exchange_in_box.hpp"

#include <algorithm>
#include <cmath>

#include "core/every_dimension.hpp"
#include "soft/size_exchange.hpp"
#include "soft/soft_engine.hpp"

namespace bernal {
namespace {

/// By how much the packing fraction is raised at first, from a packing that just touches.
constexpr double first_compression = 1.006;
/// By how much edges become shorter at most.
constexpr double most_shrinking = 1.1;

}  // namespace

template <int D>
std::optional<double> exchange_in_box(Spheres<D>& spheres, Vector<D>& edges, bool wide, SpheresInBox& in_box,
                                      Reporter& report) {
  SizeExchange sizes(spheres.r, D);
  if (D == 1 || !sizes.is_of_use()) return std::nullopt;
  const double from_periods_to_edges = edges.minCoeff() / in_box.shortest_period(edges);
  const double least_edge =
      std::max(edges.minCoeff() / most_shrinking,
               2 * most_shrinking * std::ranges::max(spheres.r) * from_periods_to_edges);
  SoftEngine<D> engine(spheres, edges, in_box.task.walls, 1, wide, in_box.task.tilt(edges));
  double edge = edges.minCoeff(), overlap = 0;
  const float omega = pace_for(0).omega * D / 3;
  const auto compress = [&](double factor) {
    const double shrinking = std::pow(factor, -1.0 / D);
    if (edge * shrinking < least_edge) return;
    edge *= shrinking;
    engine.grow(shrinking);
  };
  const auto sweep = [&](int sweeps) {
    for (int k = 1; k < sweeps; ++k) engine.sweep(omega);
    overlap = engine.sweep_and_measure(omega);
  };
  int k = 0;
  const Resumable part(report, "exchange in a box", [&](Archive& a) { a(k, edge, overlap, engine); });
  if (!part.resumed()) {
    compress(first_compression);
    sweep(sweeps_an_exchange);
  }
  for (; k < exchanges && !report.stop(); ++k) {
    const double done = static_cast<double>(k) / exchanges;
    if (sizes.widen(widening(done))) engine.resize(sizes.radii());
    engine.exchange(sizes.deal(engine.forces(), exchange_step(done)));
    sweep(sweeps_an_exchange);
    const double energy = energy_of(engine.squeeze());
    if (energy < crowding) {
      compress(compression);
      sweep(sweeps_an_exchange);
    } else if (sizes.is_widened() && energy > too_crowded * crowding) {
      compress(1 / compression);
    }
    if (k % exchanges_a_milestone == 0) {
      in_box.edges = edges * (edge / edges.minCoeff());
      report.milestone("exchange", in_box, overlap, done);
    }
  }
  engine.write_to(spheres, edges);
  in_box.edges = edges;
  report.effects["neighbour lists"] += engine.lists_built();
  return overlap;
}

#define BERNAL_INSTANTIATE(D) \
  template std::optional<double> exchange_in_box<D>(Spheres<D>&, Vector<D>&, bool, SpheresInBox&, Reporter&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
