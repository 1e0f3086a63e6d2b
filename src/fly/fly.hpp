#pragma once
#include <string>
#include <string_view>

#include "bernal/fly/fly.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

std::string_view name_of(FillMethod);

struct FillChoice {
  FillMethod method = FillMethod::relaxation;  ///< not automatic
  std::string reason;                          ///< a clause: "as …", "which …"
};

/// All know walls but `classes`.
/// Throws Error{bad_argument} where the method that is named cannot do it.
FillChoice choose_filling(FillMethod method, const FillTask& task);

/// The method and why it, and its effects. Throws as `choose_filling`.
std::vector<PlanItem> effects_of_flight(const Fly& options, const Outlook& outlook);

/// Collision filling in n dimensions: puts spheres of prescribed radii into the box of prescribed edges, in 1
/// to 8 dimensions; neither changes by a bit. Spheres come from large to small; those that cross a periodic
/// face reappear on the opposite side.
///
/// `converged`: all are placed, and none overlap. `full`: the rest, mostly the smallest, found no place, or
/// were wider than the box; `hit_limit` and `cancelled` as they say. Then those are left that
/// are placed, in the order in which they were drawn. Spheres that have places in that very box already stay
/// there. Precondition: `Task::target_edges`. Deterministic in the seed.
StageEnd fly(SpheresInBox& in_box, Reporter& report, const FillChoice& choice, const Fly& options);

}  // namespace bernal
