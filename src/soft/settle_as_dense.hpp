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
  double packing_fraction;  ///< of the spheres as they begin to fall, at most
  int taps = 0;             ///< before, see `tap`
  double first_tap = bernal::first_tap;
  double friction = 0;     ///< the angle, in degrees, up to which it holds a sphere that rolls
  bool is_aimed = false;   ///< at a porosity, so that what else would fit is left out
  bool finds_room = true;  ///< set by who lays it: whether they found it at that density
};

/// Lays a bed, and again from what stood there before as long as it is not as porous as the target asks for:
/// denser or looser to begin with; where relaxation packs them no denser, tapped; where they would settle
/// denser however loose they begin, with friction of the least angle that holds them. The attempt that came
/// nearest is kept. Says in `Reporter::account` how porous the bed is and what was the aim, and in
/// `Reporter::missed` where it was missed by more than 0.005. Of a bed lower than four diameters no law tells
/// the aim.
///
/// Poured: laid once, at `poured`. Cost: that of an attempt, once to some ten times.
StageEnd settle_as_dense(SpheresInBed& in_bed, Reporter& report, const BedTarget& target,
                         const Heights& heights, const BedTop& top, double poured,
                         const std::function<StageEnd(Laying&)>& lay);

}  // namespace bernal
