#include "work/checkpoints.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

/// Of the time, at most, that writing checkpoints takes: where they are large and the disk is slow they are
/// rarer than was asked for.
constexpr double most_of_the_time = 0.02;

void tell(const CheckpointOptions& options, const std::string& what) {
  if (options.tell) options.tell(what);
}

}  // namespace

Checkpoints::Checkpoints(const Monitor& monitor, const CheckpointOptions& options, CheckpointOwner owner,
                         std::function<void(Archive&)> rest)
    : monitor_(monitor),
      options_(options),
      owner_(std::move(owner)),
      rest_(std::move(rest)),
      seconds_between_(options.every) {
  if (options.folder.empty()) return;
  folder_ = std::make_unique<CheckpointFolder>(options.folder);
  bool is_ours = true;
  try {
    is_ours = folder_->claim();
  } catch (const Error&) {  // that is told of once there is something to write
  }
  if (!options.resume) {
    complained_ = !is_ours;
    if (!is_ours)
      tell(options_, fmt::format("another run is at work in {}: this one keeps no checkpoints",
                                 options.folder.string()));
    else if (CheckpointFolder::stands_in(options.folder))
      tell(options_,
           fmt::format("a run that was ended left a checkpoint in {}, which this one will replace; "
                       "‹resume› would go on from it, where it is of this scene and of these packings",
                       options.folder.string()));
    return;
  }
  std::string note;
  source_ = folder_->open(owner_, note, by_);
  if (!note.empty()) tell(options_, note);
  if (!source_) {
    tell(options_,
         fmt::format("no checkpoint of this run is in {}: it starts anew", options.folder.string()));
    return;
  }
  (*source_)(to_come_);
  tell(options_, fmt::format("going on from the checkpoint in {}", options.folder.string()));
}

Checkpoints::Part::Part(Checkpoints& of, std::string_view name, std::function<void(Archive&)> state)
    : of_(of), name_(name), state_(std::move(state)) {
  of_.begin(*this);
}

Checkpoints::Part::~Part() { std::erase(of_.parts_, this); }

void Checkpoints::begin(Part& part) {
  if (source_) go_on(part);
  parts_.push_back(&part);
}

void Checkpoints::go_on(Part& part) {
  std::string name;
  (*source_)(name);
  if (name != part.name_)
    throw Error(ErrorCode::bad_packing,
                fmt::format("a checkpoint goes on with \"{}\" where this run has \"{}\", which is a bug of "
                            "bernal; leave ‹resume› out to start anew",
                            name, part.name_));
  take(part.state_);
  part.resumed_ = true;
  if (--to_come_ > 0) return;
  take(rest_);
  source_ = nullptr;
  last_ = Clock::now();
}

void Checkpoints::take(const std::function<void(Archive&)>& state) {
  try {
    state(*source_);
    source_->check_layout();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_packing) throw;
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("holds a checkpoint of bernal {}, which keeps other things of a run than this one, "
                    "{}: go on with that one, or leave ‹resume› out to start anew",
                    text_of(by_), text_of(owner_.program)),
        {options_.folder.string()});
  }
}

bool Checkpoints::due() {
  if (options_.due) return options_.due();
  return std::chrono::duration<double>(Clock::now() - last_).count() > seconds_between_;
}

bool Checkpoints::stop() {
  if (!folder_ || paused_ > 0) return monitor_.stop();
  const bool is_due = due(), ends = monitor_.stop();
  if ((is_due || ends) && !ended_) write();
  ended_ = ended_ || ends;
  return ends;
}

void Checkpoints::write_if_long() {
  if (folder_ && std::chrono::duration<double>(Clock::now() - start_).count() > options_.every) write();
}

void Checkpoints::write() {
  if (!folder_ || source_) return;
  const Clock::time_point start = Clock::now();
  try {
    folder_->write(owner_, [this](Archive& archive) {
      auto count = static_cast<std::uint32_t>(parts_.size());
      archive(count);
      for (Part* part : parts_) {
        std::string name = part->name_;
        archive(name);
        part->state_(archive);
        archive.check_layout();
      }
      rest_(archive);
      archive.check_layout();
    });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::cannot_write) throw;
    if (!complained_) tell(options_, fmt::format("{}; the run goes on without", error.what()));
    complained_ = true;
  }
  last_ = Clock::now();
  const double seconds = std::chrono::duration<double>(last_ - start).count();
  seconds_between_ = std::max(options_.every, seconds / most_of_the_time);
}

}  // namespace bernal
