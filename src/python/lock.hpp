#pragma once
#include <cxxabi.h>

#include <pybind11/pybind11.h>

namespace bernal::python {

// The interpreter's lock, as pybind11 has it, but for the end of the interpreter: it then ends each thread
// that asks for its lock by unwinding its stack (`pthread_exit`), which C++ cannot go along with. Such a
// thread stays where it is until the process ends.

/// Never comes back; called without the interpreter's lock.
[[noreturn]] void stay();

/// What `call` answers; stays if the interpreter ends the thread meanwhile.
template <class Call>
auto or_stay(const Call& call) {
  try {
    return call();
  } catch (const abi::__forced_unwind&) {
    stay();
  }
}

/// From now on nobody gets the lock by `Locked`: the interpreter is about to go.
void end_locking();

/// Holds the interpreter's lock in a thread that the interpreter need not know.
class Locked {
 public:
  Locked();
  ~Locked();
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  PyGILState_STATE before_;
};

/// Lets others have the interpreter's lock, which the thread holds before and afterwards.
class Unlocked {
 public:
  Unlocked() : thread_(PyEval_SaveThread()) {}
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* thread_;
};

}  // namespace bernal::python
