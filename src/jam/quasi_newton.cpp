#include "jam/quasi_newton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace bernal {
namespace {

constexpr std::size_t most_pairs = 10;
/// Of the gradient, where nothing is known of the curvature.
constexpr double first_step = 0.1;
/// Of the slope, what a step has to gain; by what it is shortened where it does not, and how often.
constexpr double share_of_slope = 1e-4, shortened = 0.4;
constexpr int most_trials = 20;
/// Pairs whose curvature is lost in rounding are no use.
constexpr double least_curvature = 1e-12;
constexpr int most_idle_steps = 4;

}  // namespace

void QuasiNewton::forget() { pairs_.clear(); }

/// The two loops of the method.
void QuasiNewton::aim(const Eigen::VectorXd& gradient) {
  std::array<double, most_pairs> along{};
  direction_ = -gradient;
  for (std::size_t k = pairs_.size(); k-- > 0;) {
    along[k] = pairs_[k].inverse * pairs_[k].step.dot(direction_);
    direction_ -= along[k] * pairs_[k].change;
  }
  if (pairs_.empty())
    direction_ *= first_step;
  else
    direction_ /= pairs_.back().inverse * pairs_.back().change.squaredNorm();
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    direction_ += (along[k] - pairs_[k].inverse * pairs_[k].change.dot(direction_)) * pairs_[k].step;
}

void QuasiNewton::learn(const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
  const double curvature = step.dot(change);
  if (!(curvature > least_curvature * change.squaredNorm())) return;
  if (pairs_.size() == most_pairs)
    std::rotate(pairs_.begin(), pairs_.begin() + 1, pairs_.end());
  else
    pairs_.emplace_back();
  pairs_.back() = {step, change, 1 / curvature};
}

double QuasiNewton::minimise(Eigen::VectorXd& point, const Function& function, const Limits& limits) {
  forget();
  Eigen::VectorXd gradient(point.size()), next(point.size()), gradient_there(point.size());
  double value = function(point, gradient);
  int evaluations = 1, idle = 0;
  while (evaluations < limits.evaluations && gradient.norm() > limits.gradient && idle < most_idle_steps) {
    aim(gradient);
    if (!(gradient.dot(direction_) < 0)) {
      forget();
      aim(gradient);
    }
    const double slope = gradient.dot(direction_), longest = direction_.cwiseAbs().maxCoeff();
    double way = longest > limits.longest_move ? limits.longest_move / longest : 1, there = value;
    bool gained = false;
    for (int k = 0; k < most_trials && !gained; ++k) {
      if (k > 0) way *= shortened;
      next = point + way * direction_;
      there = function(next, gradient_there);
      ++evaluations;
      gained = there <= value + share_of_slope * way * slope;
    }
    if (!gained) {
      if (pairs_.empty()) break;
      forget();
      continue;
    }
    learn(next - point, gradient_there - gradient);
    idle = value - there < limits.improvement * std::abs(value) ? idle + 1 : 0;
    std::swap(point, next);
    std::swap(gradient, gradient_there);
    value = there;
  }
  evaluations_ += static_cast<std::uint64_t>(evaluations);
  return value;
}

}  // namespace bernal
