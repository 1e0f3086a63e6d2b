#include <gtest/gtest.h>

#include <cmath>

#include "jam/trust_region.hpp"

// The step of a quadratic function whose Hessian is so badly conditioned that conjugate gradients take
// hundreds of products.
namespace bernal {
namespace trust_region_test {

/// sum of l_i x_i² / 2 - x_i, with l_i from 1 to 1e6.
struct Valley final : SmoothFunction {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(400), curvature = x, before = x, slope = x;

  Valley() {
    for (Eigen::Index i = 0; i < x.size(); ++i)
      curvature[i] = std::pow(1e6, static_cast<double>(i) / static_cast<double>(x.size() - 1));
    set_slope();
  }
  Eigen::Index unknowns() const override { return x.size(); }
  const Eigen::VectorXd& gradient() const override { return slope; }
  void hessian_times(const Eigen::VectorXd& v, Eigen::VectorXd& out) const override {
    out = curvature.cwiseProduct(v);
  }
  void factor_preconditioner() override {}
  void precondition(const Eigen::VectorXd& v, Eigen::VectorXd& out) const override { out = v; }
  double value() const { return 0.5 * x.dot(curvature.cwiseProduct(x)) - x.sum(); }
  double move(const Eigen::VectorXd& v) override {
    before = x;
    const double from = value();
    x += v;
    set_slope();
    return value() - from;
  }
  void take_back() override {
    x = before;
    set_slope();
  }
  void set_slope() { slope = curvature.cwiseProduct(x) - Eigen::VectorXd::Ones(x.size()); }
};

TEST(TrustRegion, FindsTheMinimumOfALongValleyInOneStep) {
  Valley valley;
  const Monitor monitor;
  TrustRegion region(valley, 1e6, 1e-9, monitor);
  const double slope = region.gradient_length();
  EXPECT_TRUE(region.step(0));
  // 1e-9 is asked for; the residual that conjugate gradients carry along drifts from the true one by roundoff
  // times the condition, 1e-10, a product.
  EXPECT_LE(region.gradient_length(), 1e-9 * slope + 1e-10 * slope * static_cast<double>(region.products()));
  EXPECT_GT(region.products(), 100u);
}

TEST(TrustRegion, AsksTheMonitorWithinAStepAndThenLeavesAllAsItWas) {
  Valley valley;
  int asked = 0;
  const Monitor monitor{.on_progress = {}, .cancelled = [&] { return ++asked == 2; }};
  TrustRegion region(valley, 1e6, 1e-9, monitor);
  region.gradient_length();
  const Eigen::VectorXd from = valley.x;
  EXPECT_FALSE(region.step(0));
  EXPECT_TRUE(region.stopped());
  EXPECT_EQ(asked, 2);
  EXPECT_LT(region.products(), 40u);
  EXPECT_EQ(valley.x, from);
  EXPECT_EQ(region.radius(), 1e6);
}

TEST(TrustRegion, StaysInTheRegion) {
  Valley valley;
  const Monitor monitor;
  TrustRegion region(valley, 1e-3, 1e-9, monitor);
  region.gradient_length();
  EXPECT_TRUE(region.step(0));
  EXPECT_NEAR(valley.x.norm(), 1e-3, 1e-12);
}

}  // namespace trust_region_test
}  // namespace bernal
