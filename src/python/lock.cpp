#include "python/lock.hpp"

#include <unistd.h>

#include <atomic>

namespace bernal::python {
namespace {

std::atomic<bool>& ended() {
  static std::atomic<bool> is = false;
  return is;
}

/// Whether the interpreter has begun to end. The function is public since Python 3.13.
bool is_ending() {
#if PY_VERSION_HEX >= 0x030D0000
  return Py_IsFinalizing();
#else
  return _Py_IsFinalizing();
#endif
}

}  // namespace

void stay() {
  for (;;) pause();
}

pybind11::object called(const pybind11::object& function, const pybind11::tuple& arguments) {
  PyObject* const answer = or_stay([&] { return PyObject_CallObject(function.ptr(), arguments.ptr()); });
  if (!answer) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(answer);
}

void end_locking() { ended() = true; }

Locked::Locked() {
  if (ended() || is_ending()) stay();
  before_ = or_stay([] { return PyGILState_Ensure(); });
}

Locked::~Locked() { PyGILState_Release(before_); }

Unlocked::~Unlocked() {
  or_stay([this] { PyEval_RestoreThread(thread_); });
}

}  // namespace bernal::python
