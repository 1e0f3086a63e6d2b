#include "bernal/run/run.hpp"

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <thread>

#include "bernal/version.hpp"
#include "run/run_in_domain.hpp"

namespace bernal {

Packing run(const Plan& plan, const RunOptions& options) {
  const Stopwatch watch;
  Packing packing;
  packing.domain = plan.domain;
  packing.volume = volume_of(plan.domain);
  packing.expected_packing_fraction = plan.expected_packing_fraction;
  packing.scene = plan.scene;
  packing.seed = options.seed.value_or(plan.scene.seed);
  packing.scene.seed = packing.seed;
  packing.threads =
      options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  packing.version = version();
  const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                            static_cast<std::size_t>(std::max(1, packing.threads)));
  if (plan.scene.is_periodic()) {
    run_in_periodic_box(plan, options.monitor, watch, packing);
  } else {
    run_in_container(plan, options.monitor, watch, packing);
  }
  packing.seconds = watch.seconds();
  return packing;
}

}  // namespace bernal
