#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

#include "bernal/core/monitor.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

struct RunOptions {
  std::optional<std::uint64_t> seed = {};  ///< the scene's own if absent
  int threads = 0;                         ///< 0: as many as the machine has
  Monitor monitor = {};
  CheckpointOptions checkpoints = {};
  /// Where an engine of the scene works, and leaves its logs; made if it does not exist. Empty: in a folder
  /// for temporary files, which goes unless the engine fails.
  std::filesystem::path engine_folder = {};
};

/// Runs the plan's stages. One seed gives one packing, bit for bit, for any number of threads. Throws
/// Error{bad_argument} where it is to go on from a checkpoint of another run.
Packing run(const Plan& plan, const RunOptions& options = {});

/// Throws what `run` would throw of the spheres that the scene begins from: those that overlap, or lie
/// outside, where the first stage does not free them of it. Cost: what drawing all radii and looking for
/// overlaps costs; nothing where the scene names no start.
void check_start(const Plan& plan);

/// To be called once a result has been written into its folder: its checkpoints, and those that killed runs
/// left there, go, unless a run is at work with them.
void remove_checkpoints(const std::filesystem::path& folder);

}  // namespace bernal
