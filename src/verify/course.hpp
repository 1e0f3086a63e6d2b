#pragma once
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string_view>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "bernal/verify/certificate.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// How a certificate is made: what its caller asked for, and whether he has stopped it.
class Course {
 public:
  explicit Course(const CertifyOptions& options) : options_(options) {}

  const CertifyOptions& options() const { return options_; }
  bool stopped() const { return stopped_; }

  /// The sum of judge(k, tally) over k from 0 to n, `grain` or more of them to a task. A monitor is asked
  /// between the parts that the work is cut into for it. Once it has answered true, the rest is left out.
  template <class Judge>
  Tally for_each(std::string_view activity, std::size_t n, std::size_t grain, const Judge& judge) const {
    const bool watched = options_.monitor.on_progress || options_.monitor.cancelled;
    const std::size_t part = watched ? std::max(grain, n / parts) : n;
    Tally sum(options_.list);
    for (std::size_t begin = 0; begin < n && !stopped_; begin += part) {
      sum += reduce(begin, std::min(n, begin + part), grain, judge);
      if (watched) report(activity, std::min(n, begin + part), n);
    }
    return sum;
  }

 private:
  static constexpr std::size_t parts = 256;
  static constexpr std::chrono::milliseconds between_reports{50};

  template <class Judge>
  Tally reduce(std::size_t begin, std::size_t end, std::size_t grain, const Judge& judge) const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(begin, end, grain), Tally(options_.list),
        [&](const tbb::blocked_range<std::size_t>& range, Tally tally) {
          for (std::size_t k = range.begin(); k < range.end(); ++k) judge(k, tally);
          return tally;
        },
        [](Tally a, const Tally& b) { return a += b; });
  }

  void report(std::string_view activity, std::size_t done, std::size_t n) const {
    stopped_ = options_.monitor.stop();
    const auto now = std::chrono::steady_clock::now();
    if (now < next_report_) return;
    options_.monitor.report({activity, static_cast<double>(done) / static_cast<double>(n), {}});
    next_report_ = now + between_reports;
  }

  const CertifyOptions& options_;
  mutable bool stopped_ = false;
  mutable std::chrono::steady_clock::time_point next_report_{};
};

}  // namespace bernal::verify
