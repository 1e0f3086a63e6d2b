#include "jam/quasi_newton.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bernal {
namespace quasi_newton_test {

/// Rosenbrock's valley, whose floor is a parabola, and a bowl with axes from 1 to 1,000.
TEST(QuasiNewton, FindsTheBottomOfAValley) {
  Eigen::VectorXd point(2);
  point << -1.2, 1;
  QuasiNewton newton;
  newton.minimise(point,
                  [](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
                    const double off = x[1] - x[0] * x[0];
                    gradient << -400 * x[0] * off - 2 * (1 - x[0]), 200 * off;
                    return 100 * off * off + (1 - x[0]) * (1 - x[0]);
                  },
                  {.longest_move = 1, .gradient = 1e-9});
  EXPECT_NEAR(point[0], 1, 1e-6);
  EXPECT_NEAR(point[1], 1, 1e-6);
  EXPECT_LT(newton.evaluations(), 100u);

  Eigen::VectorXd far = Eigen::VectorXd::Constant(20, 3);
  newton.minimise(far,
                  [](const Eigen::VectorXd& x, Eigen::VectorXd& gradient) {
                    double value = 0;
                    for (Eigen::Index k = 0; k < x.size(); ++k) {
                      const double stiffness = std::pow(1000, static_cast<double>(k) / 19);
                      gradient[k] = stiffness * x[k];
                      value += 0.5 * stiffness * x[k] * x[k];
                    }
                    return value;
                  },
                  {.longest_move = 10, .gradient = 1e-8});
  EXPECT_LT(far.norm(), 1e-7);
}

}  // namespace quasi_newton_test
}  // namespace bernal
