#pragma once
#include <cstdint>
#include <optional>
#include <thread>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// The seed of the n-th of several runs that are begun by one seed; those that a scene can hold follow each
/// other in a circle.
inline std::uint64_t seed_of_run(std::uint64_t first, std::uint64_t n) {
  return (first + n) % (std::uint64_t{1} << 63);
}

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
