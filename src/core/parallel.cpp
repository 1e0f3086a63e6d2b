#include "core/parallel.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "core/precedence.hpp"

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

Precedence::Precedence(std::size_t pieces, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs)
    : waits_for_(pieces, 0), waiting_(pairs.size()), first_(pieces + 1, 0) {
  for (const auto& [earlier, later] : pairs) {
    ++waits_for_[later];
    ++first_[earlier + std::size_t{1}];
  }
  for (std::size_t k = 0; k < pieces; ++k) first_[k + 1] += first_[k];
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [earlier, later] : pairs) waiting_[next[earlier]++] = later;
}

void parallel_by_precedence(const Precedence& order, const std::function<void(std::size_t piece)>& body) {
  const std::size_t n = order.size();
  const std::unique_ptr<std::atomic<std::uint32_t>[]> left(new std::atomic<std::uint32_t>[n]);
  std::vector<std::uint32_t> ready;
  for (std::size_t k = 0; k < n; ++k) {
    left[k].store(order.waits_for(k), std::memory_order_relaxed);
    if (order.waits_for(k) == 0) ready.push_back(static_cast<std::uint32_t>(k));
  }
  // Calls it for one piece, and then for one that waited for nothing else; returns the others of these to
  // hand_on.
  const auto work = [&](std::size_t piece, const auto& hand_on) {
    for (bool goes_on = true; goes_on;) {
      throw_if_interrupted();
      body(piece);
      goes_on = false;
      std::size_t next = 0;
      for (const std::uint32_t k : order.waiting(piece)) {
        if (--left[k] > 0) continue;
        if (std::exchange(goes_on, true))
          hand_on(k);
        else
          next = k;
      }
      piece = next;
    }
  };
  if (is_alone) {
    while (!ready.empty()) {
      const std::uint32_t k = ready.back();
      ready.pop_back();
      work(k, [&](std::uint32_t other) { ready.push_back(other); });
    }
    return;
  }
  oneapi::tbb::task_group group;
  const std::function<void(std::uint32_t)> begin = [&, monitor = listens_to](std::uint32_t k) {
    group.run([&, monitor, k] {
      const Listening listening(monitor);
      work(k, begin);
    });
  };
  for (const std::uint32_t k : ready) begin(k);
  group.wait();
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
