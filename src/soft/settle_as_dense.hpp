#pragma once
#include <functional>

#include "bernal/scene/bed_target.hpp"
#include "soft/below_level.hpp"
#include "soft/tap.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// How a bed is laid.
struct Laying {
  double packing_fraction;  ///< the largest of the spheres before they fall
  int taps = 0;             ///< before they fall, see `tap`
  double first_tap = bernal::first_tap;
  double friction = 0;     ///< the angle, in degrees, up to which friction holds a sphere that rolls
  bool is_aimed = false;   ///< whether a porosity is the aim: then no other spheres are added that would fit
  bool finds_room = true;  ///< result: whether the spheres found room at that packing fraction
};

/// Lays a bed with `lay`, and lays it again, from what stood there before, until it is as porous as the
/// target asks for. The attempts begin at another packing fraction. If relaxation packs the spheres no
/// denser, they are tapped; if they settle too densely however loose they begin, friction with the least
/// sufficient angle holds them. The nearest attempt is kept. `Reporter::account` then says the porosity and the
/// aim, and `Reporter::missed` that the aim was missed by more than 0.005. No law gives an aim for a bed lower
/// than four diameters.
///
/// A poured bed is laid once, at `poured`. Cost: one to some ten attempts.
StageEnd settle_as_dense(SpheresInBed& in_bed, Reporter& report, const BedTarget& target,
                         const Heights& heights, const BedTop& top, double poured,
                         const std::function<StageEnd(Laying&)>& lay);

}  // namespace bernal
