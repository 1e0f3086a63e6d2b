#include "python/job.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "python/lock.hpp"

namespace bernal::python {

struct Job::State {
  std::atomic<bool> cancelled = false;
  std::mutex mutex;  // of all below
  std::condition_variable end;
  bool ended = false;
  std::exception_ptr error;
  Finish finish;
  std::string activity, detail;
  double fraction = -1;

  Monitor monitor() {
    return {[this](const Progress& progress) {
              const std::lock_guard lock(mutex);
              activity = progress.activity;
              detail = progress.detail;
              fraction = progress.fraction;
            },
            [this] { return cancelled.load(); }};
  }

  void run(const Work& work) {
    Finish made;
    std::exception_ptr failed;
    try {
      made = work(monitor());
    } catch (...) {
      failed = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    finish = std::move(made);
    error = failed;
    ended = true;
    end.notify_all();
  }
};

namespace {

/// The jobs that run, for the end of the program.
struct Running {
  std::mutex mutex;
  std::condition_variable none;
  std::set<std::atomic<bool>*> cancelled;  // the flags of jobs whose work has not ended
  std::size_t threads = 0;                 // those that still hold anything of their work
  bool ending = false;
  std::thread::id ender;
};
/// Those of this process: in a forked process no job of the parent runs. Never destroyed, since threads use
/// it.
Running& running() {
  static auto* all = new Running;
  static pid_t process = getpid();
  if (process != getpid()) {
    all = new Running;
    process = getpid();
  }
  return *all;
}

}  // namespace

Job::Job(Work work) : state_(std::make_shared<State>()) {
  Running& all = running();
  const std::lock_guard begin(all.mutex);
  if (all.ending) throw Ending();
  std::thread([state = state_, work = std::move(work), &all]() mutable {
    state->run(work);
    {
      const std::lock_guard lock(all.mutex);
      all.cancelled.erase(&state->cancelled);
    }
    work = {};
    state.reset();
    const std::lock_guard lock(all.mutex);
    --all.threads;
    all.none.notify_all();
  }).detach();
  all.cancelled.insert(&state_->cancelled);
  ++all.threads;
}

Job::~Job() { cancel(); }

void Job::cancel() { state_->cancelled = true; }

bool Job::wait(double seconds) const {
  const Unlocked others_run;
  std::unique_lock lock(state_->mutex);
  return state_->end.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return state_->ended; });
}

std::tuple<std::string, double, std::string> Job::progress() const {
  const std::lock_guard lock(state_->mutex);
  return {state_->activity, state_->fraction, state_->detail};
}

pybind11::object Job::result() {
  Finish finish;
  {
    const std::lock_guard lock(state_->mutex);
    if (state_->error) std::rethrow_exception(state_->error);
    finish = std::move(state_->finish);
  }
  if (!finish) throw std::logic_error("a job has one result, once it has ended");
  return finish();
}

bool is_ending_elsewhere() {
  Running& all = running();
  const std::lock_guard lock(all.mutex);
  return all.ending && all.ender != std::this_thread::get_id();
}

void stop_all_jobs() {
  const Unlocked others_run;
  Running& all = running();
  std::unique_lock lock(all.mutex);
  all.ending = true;
  all.ender = std::this_thread::get_id();
  for (std::atomic<bool>* const cancelled : all.cancelled) *cancelled = true;
  if (all.none.wait_for(lock, std::chrono::seconds(5), [&] { return all.threads == 0; })) return;
  end_locking();
  on_exit(  // the last to be registered is the first to be called
      [](int status, void*) {
        std::fflush(nullptr);
        _exit(status);
      },
      nullptr);
}

}  // namespace bernal::python
