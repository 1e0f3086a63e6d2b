#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "core/archive.hpp"
#include "work/bed.hpp"
#include "work/checkpoints.hpp"
#include "work/effect_log.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Why a stage came to its end.
enum class StageEnd {
  converged,  ///< it did what it is for
  full,       ///< no place was left for the next sphere
  hit_limit,  ///< its limit on iterations or rounds came first
  cancelled,
};

/// How far a stage has come, for the run's history and the progress bar.
struct StageProgress {
  std::string_view stage;
  std::uint64_t spheres = 0;
  double packing_fraction = 0;
  std::optional<double> potential = {};  ///< mean height in the bed, in the packer's unit
  double max_overlap = 0;                ///< largest overlap ratio of a pair
  std::optional<double> done = {};       ///< in [0, 1], where the stage knows it
  bool for_history = true;               ///< false: for the progress bar alone
};

/// Where the stages of a run report what they do, and where they ask whether to go on.
struct Reporter {
  const std::uint64_t seed;
  const Monitor& monitor;
  EffectLog& effects;
  std::function<void(const StageProgress&)> on_progress = {};
  Checkpoints* checkpoints = nullptr;  ///< null: none are written
  std::uint64_t streams_used = 0;
  /// How a stage went about it, for people: follows "all 200 spheres are placed".
  std::string account = {};
  /// What a stage was to do beside placing spheres, and did not: a sentence; empty where there is nothing.
  std::string missed = {};
  std::optional<double> bed_porosity = {};  ///< up to its surface, by the stage that laid it

  /// At a safe point of a stage, within a `Resumable`: see `Checkpoints::stop`.
  bool stop() { return checkpoints ? checkpoints->stop() : monitor.stop(); }

  /// A fresh stream of random numbers for one round of a stage.
  Random random(Stream purpose) { return {seed, stream(purpose, streams_used++)}; }

  /// To be called some hundred times a stage at most. Of spheres that stand in a bed.
  void milestone(std::string_view stage, const Bed& bed) const {
    if (!on_progress) return;
    on_progress({.stage = stage,
                 .spheres = bed.size(),
                 .packing_fraction = bed.packing_fraction(),
                 .potential = bed.potential(-Vector<3>::Unit(bed.dimension() - 1))});
  }
  /// In a box; `done` says how far the stage has come.
  void milestone(std::string_view stage, const SpheresInBox& in_box, double max_overlap, double done) const {
    if (on_progress) milestone(stage, in_box.spheres.size(), in_box.packing_fraction(), max_overlap, done);
  }
  /// Of spheres that are in neither, because they overlap or are still to grow, and for who knows these.
  void milestone(std::string_view stage, std::size_t spheres, double packing_fraction, double max_overlap,
                 double done, bool for_history = true) const {
    if (!on_progress) return;
    on_progress({.stage = stage,
                 .spheres = spheres,
                 .packing_fraction = packing_fraction,
                 .max_overlap = max_overlap,
                 .done = std::clamp(done, 0.0, 0.99),
                 .for_history = for_history});
  }

  /// For a part of a stage: it writes no checkpoints and nobody is told of its progress.
  Reporter alone() const {
    return {.seed = seed, .monitor = monitor, .effects = effects, .streams_used = streams_used};
  }

  /// What a stage leaves to the next.
  void archive(Archive& a) { a(account, missed, bed_porosity, streams_used); }
};

/// The state of a stage, or of what it does, while this lives: see `Checkpoints::Part`. In a run without
/// checkpoints it is none.
class Resumable {
 public:
  Resumable(const Reporter& report, std::string_view name, std::function<void(Archive&)> state) {
    if (report.checkpoints) part_.emplace(*report.checkpoints, name, std::move(state));
  }
  bool resumed() const { return part_ && part_->resumed(); }

 private:
  std::optional<Checkpoints::Part> part_;
};

/// Checkpoints are not written while this lives.
class NotResumable {
 public:
  explicit NotResumable(const Reporter& report) : pause_(report.checkpoints) {}

 private:
  const Checkpoints::Pause pause_;
};

}  // namespace bernal
