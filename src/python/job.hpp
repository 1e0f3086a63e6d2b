#pragma once
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <tuple>

#include <pybind11/pybind11.h>

#include "bernal/core/monitor.hpp"

namespace bernal::python {

/// Work that goes on in a thread of its own and knows nothing of Python, so that whoever waits for it can
/// hear interrupts, show how far it has come, and give up waiting. What it makes becomes an object of Python
/// in the thread that asks for that.
class Job {
 public:
  using Finish = std::function<pybind11::object()>;  ///< called with the interpreter's lock, others without
  using Work = std::function<Finish(const Monitor&)>;

  /// Begins; throws Ending where that is too late. What `work` and its answer hold may be destroyed in any
  /// thread without the interpreter's lock.
  explicit Job(Work work);
  /// Tells the work to stop at its next safe point and does not wait for that.
  ~Job();
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Whether the work has ended, after waiting so long for it at most; the interpreter runs on meanwhile.
  bool wait(double seconds) const;
  /// Activity, fraction (negative where nobody knows), detail: see Progress.
  std::tuple<std::string, double, std::string> progress() const;
  /// Asks the work to stop at its next safe point.
  void cancel();
  /// What came of it; throws what the work threw. Precondition: it has ended.
  pybind11::object result();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

/// The program ends, and nothing new may begin.
struct Ending : std::exception {
  const char* what() const noexcept override { return "nothing can begin any more, since the program ends"; }
};

/// Whether stop_all_jobs was called, in another thread.
bool is_ending_elsewhere();

/// Stops all work and waits until the last thread has ended: what it uses is about to be taken down. From
/// then on nothing begins. Work that has come to no safe point after five seconds is left alone; the process
/// then ends without taking down what such work uses.
void stop_all_jobs();

}  // namespace bernal::python
