#include "jam/trust_region.hpp"

#include <algorithm>
#include <cmath>

namespace bernal {
namespace {

constexpr double acceptable = 1e-4, bad = 0.25, good = 0.75;
constexpr int most_products = 20'000;
constexpr int products_unasked = 16;  // from one question to the monitor to the next

}  // namespace

TrustRegion::TrustRegion(SmoothFunction& function, double radius, double forcing, const Monitor& monitor)
    : function_(function),
      radius_(radius),
      forcing_(forcing),
      monitor_(monitor),
      z_(function.unknowns()),
      h_(Eigen::VectorXd::Zero(function.unknowns())) {}

double TrustRegion::gradient_length() {
  function_.factor_preconditioner();
  function_.precondition(function_.gradient(), z_);
  return std::sqrt(function_.gradient().dot(z_));
}

bool TrustRegion::step(double resolution) {
  propose();
  while (!proposals_.empty()) {
    const Proposal proposal = std::move(proposals_.back());
    proposals_.pop_back();
    double change = function_.move(proposal.step);
    if (proposal.gain < resolution && std::isfinite(change))
      change = 0.5 * (proposal.slope + function_.gradient().dot(proposal.step));
    const double ratio = -change / proposal.gain;
    if (ratio < bad)
      radius_ = proposal.length / 4;
    else
      radius_ = std::max(ratio > good ? 2 * proposal.length : proposal.length, at_border_ ? 0 : radius_);
    if (ratio > acceptable) return true;
    function_.take_back();
    at_border_ = true;  // of what is left
  }
  return false;
}

/// Fills `proposals_`, the longest last.
void TrustRegion::propose() {
  const Eigen::VectorXd& g = function_.gradient();
  proposals_.clear();
  at_border_ = false;
  step_.setZero(g.size());
  residual_ = g;
  function_.precondition(residual_, z_);
  direction_ = -z_;
  double rz = residual_.dot(z_);
  const double enough = forcing_ * forcing_ * rz;
  double border = radius_ / 16;
  double ss = 0, sd = 0, dd = rz;  // products of step and direction in the metric
  for (int i = 0; i < most_products && rz > enough; ++i) {
    if (i % products_unasked == products_unasked - 1 && monitor_.stop()) {
      stopped_ = true;
      proposals_.clear();
      return;
    }
    function_.hessian_times(direction_, h_);
    ++products_;
    const double curvature = direction_.dot(h_);
    const double alpha = curvature > 0 ? rz / curvature : 0;
    while (!(curvature > 0) || ss + alpha * (2 * sd + alpha * dd) >= border * border) {
      const double way = (-sd + std::sqrt(sd * sd + dd * (border * border - ss))) / dd;
      keep(way, border);
      if (border >= radius_) {
        at_border_ = true;
        return;
      }
      border *= 4;
    }
    step_ += alpha * direction_;
    residual_ += alpha * h_;
    ss += alpha * (2 * sd + alpha * dd);
    function_.precondition(residual_, z_);
    const double next = residual_.dot(z_), beta = next / rz;
    direction_ = beta * direction_ - z_;
    sd = beta * (sd + alpha * dd);
    dd = next + beta * beta * dd;
    rz = next;
  }
  keep(0, std::sqrt(ss));
}

/// Keeps the step lengthened by `way` along the direction.
void TrustRegion::keep(double way, double length) {
  Proposal p{step_ + way * direction_, 0, length, 0};
  p.slope = function_.gradient().dot(p.step);
  p.gain = -0.5 * (p.slope + residual_.dot(p.step) + way * h_.dot(p.step));
  proposals_.push_back(std::move(p));
}

}  // namespace bernal
