#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <string_view>

#include "bernal/verify/certificate.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// How a certificate is made: what its caller asked for, and whether he has stopped it.
class Course {
 public:
  explicit Course(const CertifyOptions& options) : options_(options) {}

  const CertifyOptions& options() const { return options_; }
  bool stopped() const { return stopped_; }

  /// What is judged from now on is part `at` of so many.
  void goes_on(std::size_t at, std::size_t parts) const {
    at_ = at;
    parts_ = parts;
  }

  using Judge = std::function<void(std::size_t k, Tally& tally)>;

  /// The sum of judge(k, tally) over k from 0 to n, `grain` or more of them to a task. A monitor is asked
  /// between the parts that the work is cut into for it. Once it has answered true, the rest is left out.
  Tally for_each(std::string_view activity, std::size_t n, std::size_t grain, const Judge& judge) const;

 private:
  void report(std::string_view activity, std::size_t done, std::size_t n) const;

  const CertifyOptions& options_;
  mutable bool stopped_ = false;
  mutable std::size_t at_ = 0, parts_ = 1;
  mutable std::chrono::steady_clock::time_point next_report_{};
};

}  // namespace bernal::verify
