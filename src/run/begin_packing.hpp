#pragma once
#include <cstdint>
#include <optional>
#include <thread>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// What a packing says of its run before there are spheres: the scene, with the seed that it is run with,
/// what the plan expects, and the threads, as many as the machine has where they are 0.
inline Packing begin_packing(const Plan& plan, std::optional<std::uint64_t> seed, int threads) {
  Packing packing;
  packing.expected_packing_fraction = plan.expected_packing_fraction;
  packing.caution = plan.caution;
  packing.hints = plan.hints;
  packing.scene = plan.scene;
  packing.seed = seed.value_or(plan.scene.seed);
  packing.scene.seed = packing.seed;
  packing.threads = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  packing.program = this_program();
  return packing;
}

}  // namespace bernal
