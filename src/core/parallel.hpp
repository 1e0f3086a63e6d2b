#pragma once
#include <cstddef>
#include <functional>

#include "bernal/core/monitor.hpp"

namespace bernal {

// Work in as many threads as the run has. These stand before oneTBB, so that few files compile its templates.

/// While it lives, every loop that its thread begins here asks the monitor before each of its pieces, and
/// throws Cancelled once that says stop. For work that takes long and has no partial result.
class Interruptible {
 public:
  /// The monitor outlives this.
  explicit Interruptible(const Monitor& monitor);
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

 private:
  const Monitor* outer_;
};

/// The same for loops in one thread: throws Cancelled if an Interruptible lives in this thread and its
/// monitor says stop. Cost: some ns.
void throw_if_interrupted();

/// From now on the loops of this process run in the thread that begins them: for a child process, which has
/// no other one.
void stay_in_this_thread();

/// Calls body(first, last) for ranges that make up [0, n), of at most `grain` where that is possible. Returns
/// when all have returned; what one throws passes through.
void parallel_ranges(std::size_t n, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body);

/// Calls body(k) for every k of [begin, end).
template <class Body>
void parallel_for(std::size_t begin, std::size_t end, const Body& body) {
  parallel_ranges(end - begin, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = begin + first; k < begin + last; ++k) body(k);
  });
}
template <class Body>
void parallel_for(std::size_t n, const Body& body) {
  parallel_for(0, n, body);
}

/// The two above, or in this thread alone where not `in_threads`: so in a piece of a loop that keeps memory
/// by thread, as a thread that waits for its own pieces may be given another one of that loop.
template <class Body>
void parallel_ranges_if(bool in_threads, std::size_t n, std::size_t grain, const Body& body) {
  if (in_threads) {
    parallel_ranges(n, grain, body);
  } else {
    body(std::size_t{0}, n);
  }
}
template <class Body>
void parallel_for_if(bool in_threads, std::size_t n, const Body& body) {
  parallel_ranges_if(in_threads, n, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) body(k);
  });
}

/// Calls both.
void parallel_both(const std::function<void()>& one, const std::function<void()>& other);

}  // namespace bernal
