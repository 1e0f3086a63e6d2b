#pragma once
#include <functional>
#include <string_view>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "work/bed.hpp"
#include "work/stage_end.hpp"
#include "work/supply.hpp"

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
  /// The same while spheres are not in the bed, because they overlap or are still to grow: their number,
  /// volume and largest overlap ratio, and how far the stage has come, in [0, 1].
  std::function<void(std::string_view stage, std::size_t spheres, double volume, double max_overlap,
                     double done)>
      crowd_milestone;
  const Target& target;
  /// What the bed's container is, in the same coordinates.
  const Domain& shape;
  /// The packing fraction that the stages are likely to reach.
  const double attainable;
  std::uint64_t streams_used = 0;

  /// A fresh stream of random numbers for one round of a stage.
  Random random(Stream purpose) { return {seed, stream(purpose, streams_used++)}; }
};

}  // namespace bernal
