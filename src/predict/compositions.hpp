#pragma once
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bernal/predict/design.hpp"

namespace bernal::predict {

/// Shares that sum to 1 from a point in a cube of one dimension less: x_k = u_k (1 - x_1 - … - x_(k-1)), and
/// the last is the remainder; `backward` starts at the other end.
std::vector<double> shares_at(std::span<const double> u, bool backward = false);
/// The point in the cube for shares in any scale.
std::vector<double> place_of(std::vector<double> shares, bool backward = false);

/// The k-th of points that fill a unit cube evenly: frac(1/2 + k / root^j), root^(d+1) = root + 1, j = 1 … d.
/// Source: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018).
std::vector<double> even_point(int k, int dimensions);
/// The k-th of compositions spread evenly over the simplex; number 0 has equal shares.
std::vector<double> even_composition(int k, int populations);

/// The distribution with these volume shares of spheres of these radii, in a fixed order, without zero shares
/// and with equal radii merged.
std::unique_ptr<SizeDistribution> mixture_of(std::span<const double> radii, std::span<const double> shares);

/// Sets `agreeing` and `spread` from the packing fractions that the starts reached; those within `same` of
/// the best agree.
void set_certainty(Optimum&, std::span<const double> ends, double same);

/// Throws Error{bad_argument} if rods cannot represent sizes of this ratio, >= 1.
void require_few_enough(double ratio, int rods);

/// Throws Error{bad_argument} unless 0 < min < max and this many rods can represent both.
void require_limits(double min, double max, int rods);

/// The number of rods for most of a search for an answer with `rods`.
int few_rods(int rods);

/// Evaluates the rod model for a search, and reports progress to the monitor.
class Evaluator {
 public:
  explicit Evaluator(const Monitor& monitor) : monitor_(monitor) {}

  /// The packing fraction of these sizes, minus the excess of Prediction::error over 1e-4.
  double phi(const SizeDistribution& sizes, int rods);
  /// Whether the monitor has asked to stop.
  bool stopped();

  int evaluations = 0;
  double fraction = 0;  ///< share of the search that is done
  std::string activity;

 private:
  void report();

  const Monitor& monitor_;
  double densest_ = 0;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point reported_{};
};

}  // namespace bernal::predict
