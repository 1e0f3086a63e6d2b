#include "python/lock.hpp"

#include <unistd.h>

#include <atomic>

namespace bernal::python {
namespace {

std::atomic<bool>& ended() {
  static std::atomic<bool> is = false;
  return is;
}

}  // namespace

void stay() {
  for (;;) pause();
}

void end_locking() { ended() = true; }

Locked::Locked() {
  if (ended() || _Py_IsFinalizing()) stay();
  before_ = or_stay([] { return PyGILState_Ensure(); });
}

Locked::~Locked() { PyGILState_Release(before_); }

Unlocked::~Unlocked() {
  or_stay([this] { PyEval_RestoreThread(thread_); });
}

}  // namespace bernal::python
