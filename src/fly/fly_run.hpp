#pragma once
#include "bernal/fly/fly.hpp"
#include "core/archive.hpp"
#include "fly/flying_spheres.hpp"

namespace bernal {

/// Inserts and flies in turn until all are placed, none finds a place for long, or the user stops it. What is
/// placed by then is what `work` holds in the end.
template <class Flight, int D>
StageEnd fly_until_full(Work& work, const Fly& options) {
  constexpr double milestone_every = 0.01;
  FlyingSpheres<D> spheres(work);
  Flight flight(spheres, options, work.random(Stream::fly));
  StageEnd end = StageEnd::converged;
  double reported = 0;
  const Resumable part(work, "flight", [&](Archive& a) {
    a(reported, work.placed_share, work.placed_count, spheres, flight);
  });
  while (!spheres.queue().empty()) {
    if (work.stop()) {
      end = StageEnd::cancelled;
      break;
    }
    flight.insert();
    if (spheres.in_vain() > options.patience * static_cast<double>(spheres.wanted())) {
      end = StageEnd::full;
      break;
    }
    if (spheres.queue().empty()) break;
    flight.fly();
    const double share = spheres.share();
    if (share < reported + milestone_every) continue;
    reported = share;
    work.placed_share = share;
    work.placed_count = spheres.size();
    work.milestone("fly", std::min(share, 0.99), 0);
  }
  if (flight.collisions() > 0)
    work.effects["collisions"] += {"", flight.collisions(), flight.seconds_of_collisions()};
  work.spheres = spheres.result();
  work.edges = *work.target_edges;
  work.placed = true;
  return end;
}

}  // namespace bernal
