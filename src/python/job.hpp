#pragma once
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <tuple>

#include <pybind11/pybind11.h>

#include "bernal/core/monitor.hpp"

namespace bernal::python {

/// Work in a thread of its own that does not use Python. The thread that waits for it can meanwhile react to
/// interrupts, show progress and stop waiting. `result` makes an object of Python in the thread that calls
/// it.
class Job {
 public:
  using Finish = std::function<pybind11::object()>;  ///< called with the interpreter's lock
  using Work = std::function<Finish(const Monitor&)>;

  /// Starts the work. Throws Ending if the program ends. Any thread may destroy what `work` and its answer
  /// hold, without the interpreter's lock.
  explicit Job(Work work);
  /// Tells the work to stop at its next safe point, without waiting for that.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Waits at most so long, without the interpreter's lock, and returns whether the work has ended.
  bool wait(double seconds) const;
  /// Activity, fraction (negative if unknown) and detail, see Progress.
  std::tuple<std::string, double, std::string> progress() const;
  /// Asks the work to stop at its next safe point.
  void cancel();
  /// The result; throws what the work threw. Precondition: it has ended.
  pybind11::object result();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// The program ends, and no job may begin.
struct Ending : std::exception {
  const char* what() const noexcept override { return "nothing can begin any more, since the program ends"; }
};

/// Whether another thread has called stop_all_jobs.
bool is_ending_elsewhere();

/// Stops all jobs and waits until their threads have ended, before the process destroys what they use. From
/// then on no job begins. If a job reaches no safe point within five seconds, the process ends without
/// destroying anything.
void stop_all_jobs();

}  // namespace bernal::python
