#pragma once
#include "bernal/fly/fly.hpp"
#include "core/archive.hpp"
#include "fly/flying_spheres.hpp"
#include "work/reporter.hpp"

namespace bernal {

/// Inserts and flies in turn until all are placed, none finds a place for long, or the user stops it. What is
/// placed by then is what is left in the box in the end.
template <class Flight, int D>
StageEnd fly_until_full(SpheresInBox& in_box, Reporter& report, const Fly& options) {
  constexpr double milestone_every = 0.01;
  FlyingSpheres<D> spheres(in_box);
  Flight flight(spheres, options, report.random(Stream::fly));
  StageEnd end = StageEnd::converged;
  double reported = 0;
  const Resumable part(report, "flight", [&](Archive& a) { a(reported, spheres, flight); });
  const double filled = in_box.packing_fraction();
  while (!spheres.queue().empty()) {
    if (report.stop()) {
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
    report.milestone("fly", spheres.size(), share * filled, 0, share);
  }
  if (flight.collisions() > 0)
    report.effects["collisions"] += {"", flight.collisions(), flight.seconds_of_collisions()};
  in_box.leave(spheres.write_to(in_box.spheres));
  in_box.edges = *in_box.task.target_edges;
  in_box.placed = true;
  return end;
}

}  // namespace bernal
