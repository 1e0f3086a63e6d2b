#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/scene/packing.hpp"
#include "core/archive.hpp"
#include "work/checkpoint_folder.hpp"

namespace bernal {

/// Keeps the state of a run now and then, so that another process can go on from there to the same bits.
///
/// The state is that of the `Part`s which live at the time, one within the other, as the functions that made
/// them are called one within the other. To go on, the same functions are called again: each part takes its
/// state as it is made, and `resumed` tells its function to pass over what is already done. So a part's state
/// is what its function and those outside of all parts have changed since it began, and what the way to the
/// next part within is decided by; what is before it is done again, which has to be quick and to come to the
/// same.
///
/// A function asks `stop` where its state is whole: at a safe point. There, and nowhere else, a checkpoint
/// may be written. Precondition: the same calls, in the same order, make the same parts, whatever the number
/// of threads.
class Checkpoints {
 public:
  /// A run without any.
  explicit Checkpoints(const Monitor& monitor) : monitor_(monitor) {}
  /// One that writes them, and goes on from the latest if it is to; `rest` is kept behind all parts, and
  /// taken once all have theirs. Throws what `CheckpointFolder::open` does.
  Checkpoints(const Monitor& monitor, const CheckpointOptions& options, CheckpointOwner owner,
              std::function<void(Archive&)> rest);

  class Part {
   public:
    /// `state` writes it, and reads it where the run goes on: then it does so before this returns.
    Part(Checkpoints& of, std::string_view name, std::function<void(Archive&)> state);
    ~Part();
    Part(const Part&) = delete;
    Part& operator=(const Part&) = delete;

    /// Whether its state is that of a checkpoint.
    bool resumed() const { return resumed_; }

   private:
    friend class Checkpoints;
    Checkpoints& of_;
    const std::string name_;
    const std::function<void(Archive&)> state_;
    bool resumed_ = false;
  };

  /// While it lives no checkpoint is written: what is done has no parts, and is short.
  class Pause {
   public:
    explicit Pause(Checkpoints* of) : of_(of) {
      if (of_) ++of_->paused_;
    }
    ~Pause() {
      if (of_) --of_->paused_;
    }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Checkpoints* const of_;
  };

  /// At a safe point: whether the run is to end here. Before that, or when one is due, writes a checkpoint.
  /// Cost: some 30 ns, and what writing takes, which is made to be less than one part in fifty of the time.
  bool stop();
  /// Writes one now, if that is what this does.
  void write();
  /// Of a long run, at its end: what follows need not cost the run.
  void write_if_long();

  /// Whether any are written.
  bool keeps() const { return folder_ != nullptr; }

 private:
  using Clock = std::chrono::steady_clock;
  bool due();
  void begin(Part& part);
  void go_on(Part& part);
  void take(const std::function<void(Archive&)>& state);

  const Monitor& monitor_;
  CheckpointOptions options_;
  CheckpointOwner owner_;
  std::function<void(Archive&)> rest_;
  std::unique_ptr<CheckpointFolder> folder_;  // null: none is written
  std::vector<Part*> parts_;                  // that live, the outermost first
  std::unique_ptr<Archive> source_;           // while parts take their states
  Program by_;                                // that wrote it
  std::uint32_t to_come_ = 0;                 // parts in it
  int paused_ = 0;
  bool ended_ = false, complained_ = false;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  double seconds_between_ = 0;
};

}  // namespace bernal
