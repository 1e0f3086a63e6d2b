#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "bernal/core/monitor.hpp"

namespace bernal {

/// Minimises a function of many variables by Newton steps within a trust region. `System` has gradient(),
/// hessian_times(v, out), factor_preconditioner(), precondition(v, out) with a positive definite
/// preconditioner M, move(v), which returns by how much the function changed, and take_back(); the function's
/// Hessian may be indefinite and jump. Lengths are sqrt(v·Mv); a gradient's is sqrt(g·M⁻¹g).
///
/// A step minimises g·v + v·Hv/2 by conjugate gradients until they meet the border of the region or negative
/// curvature. What the iteration had at a quarter and a sixteenth of the region's radius is kept, so that a
/// step that turns out too long costs no new iteration. Source: Steihaug, SIAM J. Numer. Anal. 20, 626
/// (1983); Conn, Gould & Toint, Trust-Region Methods (2000), 7.5.
template <class System>
class TrustRegion {
 public:
  /// The equations of a step are solved to `forcing`, relative to the gradient; or as far as they are when
  /// the monitor says stop.
  TrustRegion(System& system, double radius, double forcing, const Monitor& monitor)
      : system_(system),
        radius_(radius),
        forcing_(forcing),
        monitor_(monitor),
        z_(system.unknowns()),
        h_(Eigen::VectorXd::Zero(system.unknowns())) {}

  /// Length of the gradient.
  double gradient_length() {
    system_.factor_preconditioner();
    system_.precondition(system_.gradient(), z_);
    return std::sqrt(system_.gradient().dot(z_));
  }

  /// One step. Call gradient_length() before each. A change of the function below `resolution` may be
  /// lost in its rounding: it is taken from the slopes at both ends. Returns whether something moved; else
  /// the region has become smaller.
  bool step(double resolution) {
    propose();
    while (!proposals_.empty()) {
      const Proposal proposal = std::move(proposals_.back());
      proposals_.pop_back();
      double change = system_.move(proposal.step);
      if (proposal.gain < resolution) change = 0.5 * (proposal.slope + system_.gradient().dot(proposal.step));
      const double ratio = -change / proposal.gain;
      if (ratio < bad)
        radius_ = proposal.length / 4;
      else
        radius_ = std::max(ratio > good ? 2 * proposal.length : proposal.length, at_border_ ? 0 : radius_);
      if (ratio > acceptable) return true;
      system_.take_back();
      at_border_ = true;  // of what is left
    }
    return false;
  }

  std::uint64_t products() const { return products_; }

 private:
  static constexpr double acceptable = 1e-4, bad = 0.25, good = 0.75;
  static constexpr int most_products = 20'000;
  static constexpr int products_unasked = 16;  // from one question to the monitor to the next

  struct Proposal {
    Eigen::VectorXd step;
    double gain, length, slope;  // slope: gradient · step
  };

  /// Fills `proposals_`, the longest last.
  void propose() {
    const Eigen::VectorXd& g = system_.gradient();
    proposals_.clear();
    at_border_ = false;
    step_.setZero(g.size());
    residual_ = g;
    system_.precondition(residual_, z_);
    direction_ = -z_;
    double rz = residual_.dot(z_);
    const double enough = forcing_ * forcing_ * rz;
    double border = radius_ / 16;
    double ss = 0, sd = 0, dd = rz;  // products of step and direction in the metric
    for (int i = 0; i < most_products && rz > enough; ++i) {
      if (i % products_unasked == products_unasked - 1 && monitor_.stop()) break;
      system_.hessian_times(direction_, h_);
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
      system_.precondition(residual_, z_);
      const double next = residual_.dot(z_), beta = next / rz;
      direction_ = beta * direction_ - z_;
      sd = beta * (sd + alpha * dd);
      dd = next + beta * beta * dd;
      rz = next;
    }
    keep(0, std::sqrt(ss));
  }

  /// Keeps the step lengthened by `way` along the direction.
  void keep(double way, double length) {
    Proposal p{step_ + way * direction_, 0, length, 0};
    p.slope = system_.gradient().dot(p.step);
    p.gain = -0.5 * (p.slope + residual_.dot(p.step) + way * h_.dot(p.step));
    proposals_.push_back(std::move(p));
  }

  System& system_;
  double radius_;
  double forcing_;
  const Monitor& monitor_;
  std::uint64_t products_ = 0;
  bool at_border_ = false;
  std::vector<Proposal> proposals_;
  Eigen::VectorXd step_, residual_, direction_, z_, h_;
};

}  // namespace bernal
