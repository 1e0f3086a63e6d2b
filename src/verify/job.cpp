#include "verify/job.hpp"

#include <algorithm>
#include <mutex>

#include "core/parallel.hpp"

namespace bernal::verify {
namespace {

/// Number of parts of the work, or of a slab, if there is a monitor.
constexpr std::size_t parts = 256;
constexpr std::chrono::milliseconds between_reports{50};

}  // namespace

Tally Job::for_each(std::string_view activity, std::size_t n, std::size_t grain, const Judge& judge) const {
  const bool watched = options_.monitor.on_progress || options_.monitor.cancelled;
  const std::size_t part = watched ? std::max(grain, n / parts) : n;
  Tally sum(options_.list);
  std::mutex adding;
  for (std::size_t begin = 0; begin < n && !stopped_; begin += part) {
    const std::size_t end = std::min(n, begin + part);
    parallel_ranges(end - begin, grain, [&](std::size_t first, std::size_t last) {
      Tally tally(options_.list);
      for (std::size_t k = begin + first; k < begin + last; ++k) judge(k, tally);
      const std::lock_guard lock(adding);
      sum += tally;
    });
    if (watched) report(activity, end, n);
  }
  return sum;
}

void Job::report(std::string_view activity, std::size_t done, std::size_t n) const {
  stopped_ = options_.monitor.stop();
  const auto now = std::chrono::steady_clock::now();
  if (now < next_report_) return;
  const double here = static_cast<double>(done) / static_cast<double>(n);
  options_.monitor.report({activity, (static_cast<double>(at_) + here) / static_cast<double>(parts_), {}});
  next_report_ = now + between_reports;
}

}  // namespace bernal::verify
