#pragma once
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "bernal/core/monitor.hpp"

namespace bernal {

/// A function of many variables at its current point, for a TrustRegion. Its Hessian may be indefinite and
/// discontinuous.
class SmoothFunction {
 public:
  virtual ~SmoothFunction() = default;
  virtual Eigen::Index unknowns() const = 0;
  virtual const Eigen::VectorXd& gradient() const = 0;
  /// out = Hessian · v.
  virtual void hessian_times(const Eigen::VectorXd& v, Eigen::VectorXd& out) const = 0;
  /// For the current point; positive definite.
  virtual void factor_preconditioner() = 0;
  /// out = M⁻¹ v, with the preconditioner M.
  virtual void precondition(const Eigen::VectorXd& v, Eigen::VectorXd& out) const = 0;
  /// Moves by v. Returns the change of the function; infinite if the move is not allowed.
  virtual double move(const Eigen::VectorXd& v) = 0;
  /// Undoes the last move.
  virtual void take_back() = 0;
};

/// Minimises a function by Newton steps within a trust region. Lengths are sqrt(v·Mv) for the preconditioner
/// M; a gradient's is sqrt(g·M⁻¹g).
///
/// A step minimises g·v + v·Hv/2 by conjugate gradients until they meet the border of the region or negative
/// curvature. The iterates at a quarter and a sixteenth of the region's radius are kept, so that a step that
/// turns out too long costs no new iteration. Source: Steihaug, SIAM J. Numer. Anal. 20, 626 (1983); Conn,
/// Gould & Toint, Trust-Region Methods (2000), 7.5.
class TrustRegion {
 public:
  /// The equations of a step are solved to `forcing`, relative to the gradient.
  TrustRegion(SmoothFunction& function, double radius, double forcing, const Monitor& monitor);

  /// Length of the gradient.
  double gradient_length();

  /// One step. Call gradient_length() before each. A change of the function below `resolution`, which
  /// rounding may hide, is computed from the slopes at both ends. Returns whether the point moved; otherwise
  /// the region has shrunk, or the monitor stopped and nothing changed.
  bool step(double resolution);

  /// Whether the monitor stopped within a step.
  bool stopped() const { return stopped_; }
  std::uint64_t products() const { return products_; }
  double radius() const { return radius_; }

 private:
  struct Proposal {
    Eigen::VectorXd step;
    double gain, length, slope;  // slope: gradient · step
  };

  void propose();
  void keep(double way, double length);

  SmoothFunction& function_;
  double radius_;
  double forcing_;
  const Monitor& monitor_;
  std::uint64_t products_ = 0;
  bool at_border_ = false, stopped_ = false;
  std::vector<Proposal> proposals_;
  Eigen::VectorXd step_, residual_, direction_, z_, h_;
};

}  // namespace bernal
