#pragma once
#include <cstdint>

#include "bernal/core/monitor.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/soft/relax.hpp"

namespace bernal {

/// How sizes are packed to see whether a prediction holds.
struct CheckOptions {
  std::int64_t spheres = 0;  ///< 0: enough for the sizes, see `spheres_for`
  Stage stage = Relax{};     ///< that packs in a periodic box
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: as many as the machine has
  Monitor monitor = {};
  double gap_factor = rod_gap_factor;  ///< of the prediction
};

/// What a packing in a periodic box says about a prediction.
struct PredictionCheck {
  double phi = 0;        ///< of the packing
  double predicted = 0;  ///< for the spheres that were packed, which are so many and no more
  std::size_t spheres = 0;
  bool certified = false;
  double coordination = 0;  ///< contacts of a sphere, at gaps of 0.002 of the mean radius sum
  Outcome outcome = Outcome::converged;
  double seconds = 0;
};

/// How many spheres stand for a distribution: 10,000, or the least of 20,000, 50,000, 100,000 and 200,000 of
/// which the largest has at most 2 % of the volume, or 200,000.
std::int64_t spheres_for(const SizeDistribution& radii);

/// Sizes, as a scene has them, in a periodic box that becomes as large as the packing needs, drawn by
/// quantiles. Throws Error{bad_scene} where no such stage can work there.
Scene scene_to_check(const SceneSizes& sizes, bool sizes_are_diameters, const CheckOptions&);

/// Packs such a scene, certifies and measures it. Cost: that of the stage; with relax 2 s for 10,000 spheres
/// whose sizes differ little, on one core.
PredictionCheck check_prediction(const Scene& scene, const CheckOptions&);

}  // namespace bernal
