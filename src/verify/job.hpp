#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string_view>

#include "bernal/verify/certificate.hpp"
#include "verify/least_gap.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// A certification in progress: its options, whether the monitor has stopped it, and the smallest gap ratios
/// found so far.
class Job {
 public:
  Job(const CertifyOptions& options, double largest_radius)
      : options_(options), largest_radius_(largest_radius) {}

  const CertifyOptions& options() const { return options_; }
  bool stopped() const { return stopped_; }

  /// Of two balls, and of a ball and a wall.
  LeastSoFar& least_pair_gap() const { return least_pair_gap_; }
  LeastSoFar& least_wall_gap() const { return least_wall_gap_; }
  /// For pairs that are as near as the nearest so far. `largest`: as in Widening.
  Widening to_nearest_so_far(double largest) const {
    return {least_pair_gap_.value(), options_.gap, largest_radius_, largest};
  }

  /// Tells the monitor that part `at` of `parts` follows.
  void set_part(std::size_t at, std::size_t parts) const {
    at_ = at;
    parts_ = parts;
  }

  using Judge = std::function<void(std::size_t k, Tally& tally)>;

  /// The sum of judge(k, tally) over k from 0 to n, at least `grain` of them a task. With a monitor, the work
  /// is divided into parts, and the monitor is polled between them; once it has returned true, the rest is
  /// skipped.
  Tally for_each(std::string_view activity, std::size_t n, std::size_t grain, const Judge& judge) const;

 private:
  void report(std::string_view activity, std::size_t done, std::size_t n) const;

  const CertifyOptions& options_;
  const double largest_radius_;
  mutable LeastSoFar least_pair_gap_, least_wall_gap_;
  mutable bool stopped_ = false;
  mutable std::size_t at_ = 0, parts_ = 1;
  mutable std::chrono::steady_clock::time_point next_report_{};
};

}  // namespace bernal::verify
