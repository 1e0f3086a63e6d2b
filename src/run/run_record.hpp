#pragma once
#include <memory>
#include <utility>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "core/archive.hpp"
#include "work/counted_container.hpp"
#include "work/effect_log.hpp"
#include "work/reporter.hpp"

namespace bernal {

/// What a run tells of itself in its packing: history, effects and time. Of a run that goes on from
/// checkpoints it is that of all its processes, and nothing counts twice.
class RunRecord {
 public:
  explicit RunRecord(Packing& packing) : packing_(packing) {}

  EffectLog& effects() { return effects_; }
  /// Of this process and those before it.
  double seconds() const { return seconds_before_ + watch_.seconds(); }
  /// What these are asked is an effect, too.
  void count(std::shared_ptr<const CountedContainer> walls) { walls_ = std::move(walls); }
  /// Gives the packing the effects.
  void conclude();

  /// For checkpoints, and how many streams of random numbers stages have used. A run that goes on reads it
  /// twice: at its start, where there is no report yet, so that effects are in their order, and once
  /// everything else is there.
  void archive(Archive& a, Reporter* report);

 private:
  Effect asked_of_walls() const;

  Packing& packing_;
  const Stopwatch watch_;
  double seconds_before_ = 0;  // of processes before this one
  EffectLog effects_;
  Effect asked_before_, asked_anew_;               // of walls: then, and again until the run went on
  std::shared_ptr<const CountedContainer> walls_;  // null where no stage asks any
};

}  // namespace bernal
