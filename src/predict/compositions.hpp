#pragma once
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bernal/predict/design.hpp"

namespace bernal::predict {

/// Shares that add up to 1 as a place in a cube of one dimension less: x_k = u_k (1 - x_1 - … - x_(k-1)), the
/// last is what remains; `backward` begins at the other end.
std::vector<double> shares_at(std::span<const double> u, bool backward = false);
/// The place in the cube that shares of any scale have.
std::vector<double> place_of(std::vector<double> shares, bool backward = false);

/// The k-th of points that fill a unit cube evenly: frac(1/2 + k / root^j), root^(d+1) = root + 1, j = 1 … d.
/// Source: M. Roberts, The unreasonable effectiveness of quasirandom sequences (2018).
std::vector<double> even_point(int k, int dimensions);
/// The k-th of compositions spread evenly over the simplex; the 0th has equal shares.
std::vector<double> even_composition(int k, int populations);

/// These shares of the volume of spheres of these radii, in one order: none without a share, equal ones
/// together.
std::unique_ptr<SizeDistribution> mixture_of(std::span<const double> radii, std::span<const double> shares);

/// How sure a search is whose starts came to these packing fractions; those within `same` of the best agree.
void tell_certainty(Optimum&, std::span<const double> ends, double same);

/// Throws Error{bad_argument} where sizes of this ratio, >= 1, are farther apart than rods can stand for.
void require_few_enough(double ratio, int rods);

/// Throws Error{bad_argument} unless 0 < min < max and so many rods can stand for both.
void require_limits(double min, double max, int rods);

/// The rods that most of a search for an answer with `rods` has.
int few_rods(int rods);

/// What a search asks of the rod model, with what it tells its monitor meanwhile.
class Inquiry {
 public:
  explicit Inquiry(const Monitor& monitor) : monitor_(monitor) {}

  /// The packing fraction of these sizes, less what their Prediction::error has above 1e-4.
  double phi(const SizeDistribution& sizes, int rods);
  /// Whether the monitor has asked to stop.
  bool stopped();

  int evaluations = 0;
  double fraction = 0;  ///< of the search that is done
  std::string activity;

 private:
  void report();

  const Monitor& monitor_;
  double densest_ = 0;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point reported_{};
};

}  // namespace bernal::predict
