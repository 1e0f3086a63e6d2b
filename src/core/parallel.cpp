#include "core/parallel.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

namespace bernal {

void parallel_ranges(std::size_t n, std::size_t grain,
                     const std::function<void(std::size_t first, std::size_t last)>& body) {
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, n, grain),
                            [&](const Range& range) { body(range.begin(), range.end()); });
}

void parallel_both(const std::function<void()>& one, const std::function<void()>& other) {
  oneapi::tbb::parallel_invoke(one, other);
}

}  // namespace bernal
