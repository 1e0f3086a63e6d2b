#include "core/parallel.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>

namespace bernal {
namespace {

thread_local const Monitor* listens_to = nullptr;
bool is_alone = false;  // said once, where there is one thread

/// Lends a thread that works on a piece what the one that began the loop listens to.
class Listening {
 public:
  explicit Listening(const Monitor* monitor) : own_(listens_to) { listens_to = monitor; }
  ~Listening() { listens_to = own_; }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

 private:
  const Monitor* own_;
};

}  // namespace

Interruptible::Interruptible(const Monitor& monitor) : outer_(listens_to) { listens_to = &monitor; }
Interruptible::~Interruptible() { listens_to = outer_; }

void throw_if_interrupted() {
  if (listens_to && listens_to->stop()) throw Cancelled();
}

void stay_in_this_thread() { is_alone = true; }

void parallel_ranges(std::size_t n, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body) {
  if (is_alone) {
    for (std::size_t first = 0; first < n; first += grain) {
      throw_if_interrupted();
      body(first, std::min(n, first + grain));
    }
    return;
  }
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, n, grain), [&, monitor = listens_to](const Range& range) {
    const Listening listening(monitor);
    throw_if_interrupted();
    body(range.begin(), range.end());
  });
}

void parallel_both(const std::function<void()>& one, const std::function<void()>& other) {
  const auto listening = [monitor = listens_to](const std::function<void()>& body) {
    return [&body, monitor] {
      const Listening here(monitor);
      throw_if_interrupted();
      body();
    };
  };
  if (is_alone) {
    listening(one)();
    listening(other)();
    return;
  }
  oneapi::tbb::parallel_invoke(listening(one), listening(other));
}

}  // namespace bernal
