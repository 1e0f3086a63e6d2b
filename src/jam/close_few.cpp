#include "jam/close_few.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

namespace bernal {
namespace {

/// Of the load, from step to step; and the overlap ratio at which rounding ends that.
constexpr double fall_of_load = 0.03, closed_overlap = 1e-14;
/// A minimum is where the forces near_balance to this share of one.
constexpr double near_balance = 1e-3;
constexpr int most_solutions = 30, most_parts = 12;
/// What is added to the stiffness of all unknowns: at first, at least, at most, and from where it is no use.
constexpr double first_damping = 1e-7, least_damping = 1e-9, most_damping = 1e-2, useless_damping = 1;
constexpr double part_of_step = 0.3, enough_gain = 1e-4;

}  // namespace

std::uint64_t close_few(FewEnergy& energy, Eigen::VectorXd& point, double overlap) {
  std::uint64_t solved = 0;
  Eigen::MatrixXd stiffness;
  Eigen::LLT<Eigen::MatrixXd> factors;
  Eigen::VectorXd gradient(point.size()), there(point.size()), gradient_there(point.size());
  Eigen::VectorXd best = point;
  double best_size = energy.largest_size(point);
  for (; overlap > closed_overlap; overlap *= fall_of_load) {
    energy.set_overlap(overlap);
    double value = energy.value(point, gradient), damping = first_damping;
    const double balanced = near_balance * overlap * energy.expected_size();
    for (int step = 0; step < most_solutions && gradient.norm() > balanced && damping < useless_damping;
         ++step) {
      energy.stiffness(point, stiffness);
      stiffness.diagonal().array() += damping;
      factors.compute(stiffness);
      ++solved;
      const Eigen::VectorXd move = -factors.solve(gradient);
      const double slope = gradient.dot(move);
      double way = 1;
      bool gained = false;
      for (int k = 0; k < most_parts && !gained; ++k) {
        if (k > 0) way *= part_of_step;
        there = point + way * move;
        const double value_there = energy.value(there, gradient_there);
        // In the end only the gradient shows a gain, which rounding hides in the value.
        gained =
            value_there <= value + enough_gain * way * slope || gradient_there.norm() < 0.5 * gradient.norm();
        if (gained) value = value_there;
      }
      if (!gained) {
        damping *= 100;
        continue;
      }
      std::swap(point, there);
      std::swap(gradient, gradient_there);
      damping = way < 1 ? std::min(most_damping, 10 * damping) : std::max(least_damping, 0.3 * damping);
    }
    if (const double size = energy.largest_size(point); size > best_size) {
      best_size = size;
      best = point;
    }
  }
  point = best;
  energy.set_size(point, best_size);
  return solved;
}

}  // namespace bernal
