#pragma once
#include <type_traits>

#include <pybind11/pybind11.h>

namespace bernal::python {

// The interpreter's lock. At its end the interpreter stops each thread that asks for the lock by unwinding
// its stack (`pthread_exit`), which destructors of C++ do not survive, and pybind11's guards do nothing about
// it. With these guards such a thread waits instead until the process ends.

/// Waits for ever. Precondition: the thread does not hold the interpreter's lock.
[[noreturn]] void stay();

/// Returns what `call` returns; waits for ever if the interpreter stops the thread during the call.
/// Precondition: `call` does not throw, and nothing in it needs a destructor, which would run without the
/// lock. A guard's destructor detects the unwinding, because `catch` does not work while another exception is
/// handled.
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

/// Calls a function of Python in a thread that the interpreter may stop meanwhile. Throws what it raises.
pybind11::object called(const pybind11::object& function, const pybind11::tuple& arguments);

/// From now on `Locked` waits for ever: the interpreter is about to end.
void end_locking();

/// Holds the interpreter's lock, in any thread.
class Locked {
 public:
  Locked();
  ~Locked();
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  PyGILState_STATE before_;
};

/// Releases the interpreter's lock, and takes it again at the end.
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
