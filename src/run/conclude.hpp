#pragma once
#include "bernal/scene/packing.hpp"
#include "run/last_pressed.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

struct Plan;

struct Ending {
  const Plan& plan;      ///< as the scene states it
  bool places_expected;  ///< the last stage places as many as are expected to fit, if nothing is asked
  double unit;           ///< the packer's, in that of the scene
  double attainable;     ///< the packing fraction that the stages are likely to reach
  double close_packing;  ///< that of the same sizes without walls; 0 where no stage packs that far
  std::optional<Pressing> pressed;  ///< how the last stage that moved spheres pressed them
};

/// How the last stage's end, what stands where, and what the scene asked for make the outcome of the run and
/// the sentence behind it. The packing has its spheres and what was expected of them already. Of spheres that
/// were pressed last it tells how many do not rest, and is not converged where any do.
void conclude(Packing& packing, const SpheresOfRun& spheres, const Reporter& report, StageEnd end,
              const Ending& ending);

}  // namespace bernal
