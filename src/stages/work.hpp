#pragma once
#include <functional>
#include <string_view>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "stages/bed.hpp"
#include "stages/supply.hpp"

namespace bernal {

/// What the stages of one run share.
struct Work {
  Bed& bed;
  Supply& supply;
  const std::uint64_t seed;
  const Monitor& monitor;
  EffectLog& effects;
  /// Called after every round of a stage, for the run's history and the progress bar.
  std::function<void(std::string_view stage)> milestone;
  std::uint64_t streams_used = 0;

  /// A fresh stream of random numbers for one round of a stage.
  Random random(Stream purpose) { return {seed, stream(purpose, streams_used++)}; }
};

/// Why a stage came to its end.
enum class StageEnd {
  converged,  ///< it did what it is for
  full,       ///< no place was left for the next sphere
  hit_limit,  ///< its limit on iterations or rounds came first
  cancelled,
};

}  // namespace bernal
