#pragma once
#include <type_traits>

#include <pybind11/pybind11.h>

namespace bernal::python {

// The interpreter's lock, as pybind11 has it, but for the end of the interpreter: it then ends each thread
// that asks for its lock by unwinding its stack (`pthread_exit`), which C++ cannot go along with. Such a
// thread stays where it is until the process ends.

/// Never comes back; called without the interpreter's lock.
[[noreturn]] void stay();

/// What `call` answers; stays if the interpreter ends the thread meanwhile. Precondition: `call` throws
/// nothing, and what it holds needs no destructor, which would run without the lock. A destructor does it: a
/// `catch` of such an end is refused where another exception is being handled.
template <class Call>
auto or_stay(const Call& call) {
  struct Guard {
    bool unwinding = true;
    ~Guard() {
      if (unwinding) stay();
    }
  } guard;
  if constexpr (std::is_void_v<decltype(call())>) {
    call();
    guard.unwinding = false;
  } else {
    const auto answer = call();
    guard.unwinding = false;
    return answer;
  }
}

/// What a function of Python answers, in a thread that may be ended meanwhile. Throws what it raises.
pybind11::object called(const pybind11::object& function, const pybind11::tuple& arguments);

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
