#include "bernal/measure/cell_weights.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/made.hpp"
#include "core/parallel.hpp"
#include "measure/localised.hpp"
#include "measure/weighted_cells.hpp"

namespace bernal {
namespace {

using Numbers = Eigen::VectorXd;

Eigen::Map<const Numbers> as_vector(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// A cell keeps this share of the least volume that any begins with or is to have.
constexpr double share_kept = 0.5;
/// Of the residual, where a step solves its equations; that squares it well below rounding.
constexpr double tolerance_of_steps = 1e-9;
constexpr int most_halvings = 30;

class Newton {
 public:
  Newton(const Spheres<3>& spheres, const CellBox& box, std::vector<double> wanted)
      : spheres_(spheres), box_(box), wanted_(std::move(wanted)) {
    for (const double r : spheres.r) weights_.push_back(r * r);
    cells_ = weighted_cells(spheres_, box_, weights_);
    const double least =
        std::min(*std::ranges::min_element(cells_.volumes), *std::ranges::min_element(wanted_));
    if (!(least > 0))
      throw Error(ErrorCode::bad_argument,
                  "a sphere has no cell at the start: spheres that do not overlap all have one");
    kept_ = share_kept * least;
  }

  /// Largest deviation, over what is wanted.
  double error() const {
    double largest = 0;
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      largest = std::max(largest, std::abs(cells_.volumes[i] / wanted_[i] - 1));
    return largest;
  }

  /// False where rounding leaves no way on.
  bool step() {
    const Numbers residual = as_vector(wanted_) - as_vector(cells_.volumes);
    const Numbers change = solved(residual);
    double share = 1;
    for (int halvings = 0; halvings < most_halvings; ++halvings, share *= 0.5) {
      std::vector<double> weights = weights_;
      for (std::size_t i = 0; i < weights.size(); ++i)
        weights[i] += share * change[static_cast<Eigen::Index>(i)];
      WeightedCells cells = weighted_cells(spheres_, box_, weights);
      const double left = (as_vector(wanted_) - as_vector(cells.volumes)).norm();
      if (*std::ranges::min_element(cells.volumes) < kept_ || left > (1 - 0.5 * share) * residual.norm())
        continue;
      weights_ = std::move(weights);
      cells_ = std::move(cells);
      return true;
    }
    return false;
  }

  const WeightedCells& cells() const { return cells_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  /// Of L x = residual, with the Laplacian of the slopes. Constants are its kernel, and the residual has none
  /// but by rounding, so that conjugate gradients converge.
  Numbers solved(Numbers residual) const {
    const auto n = static_cast<Eigen::Index>(wanted_.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < cells_.slopes.size(); ++i)
      for (const auto& [neighbour, slope] : cells_.slopes[i]) {
        // Both cells have the face, to rounding: half of it from each keeps the matrix symmetric.
        const int a = static_cast<int>(i), b = static_cast<int>(neighbour);
        const double half = 0.5 * slope;
        entries.insert(entries.end(), {{a, a, half}, {b, b, half}, {a, b, -half}, {b, a, -half}});
      }
    Eigen::SparseMatrix<double, Eigen::RowMajor> laplacian(n, n);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    residual.array() -= residual.mean();
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>, Eigen::Lower | Eigen::Upper>
        solver;
    solver.setTolerance(tolerance_of_steps);
    solver.compute(laplacian);
    return solver.solve(residual);
  }

  const Spheres<3>& spheres_;
  const CellBox& box_;
  std::vector<double> wanted_, weights_;
  WeightedCells cells_;
  double kept_ = 0;
  Made made_{cells_effect};
};

void check(const Spheres<dynamic>& spheres, const Domain& domain, std::span<const double> volumes) {
  const auto fail = [](const std::string& what) { throw Error(ErrorCode::bad_argument, what); };
  if (!std::holds_alternative<Box>(domain) || spheres.dimension() != 3)
    fail("cells of given volumes are for boxes of three dimensions, periodic or between walls");
  if (spheres.empty() || volumes.size() != spheres.size())
    fail(
        fmt::format("there must be a volume for each of {} spheres, not {}", spheres.size(), volumes.size()));
  for (const double volume : volumes)
    if (!(volume > 0 && std::isfinite(volume)))
      fail(fmt::format("volumes of cells must be positive, not {}", volume));
}

}  // namespace

CellWeights weights_for_volumes(const Spheres<dynamic>& spheres, const Domain& domain,
                                std::span<const double> volumes, const CellWeightOptions& options) {
  check(spheres, domain, volumes);
  const Frame frame = frame_of(domain);
  const Domain local = to_local(domain, frame);
  const Spheres<3> there = localised(spheres, frame);
  const CellBox box{3, bounds_of(local), localised(boundary_in_space(domain), frame)};
  std::vector<double> wanted(volumes.begin(), volumes.end());
  const double scale = volume_of(local) / std::accumulate(wanted.begin(), wanted.end(), 0.0);
  for (double& volume : wanted) volume *= scale;

  Newton newton(there, box, std::move(wanted));
  CellWeights made;
  while (newton.error() > options.tolerance && made.steps < options.most_steps) {
    throw_if_interrupted();
    if (!newton.step()) break;
    ++made.steps;
  }
  made.error = newton.error();

  const std::size_t n = spheres.size();
  double shift = 0;
  for (std::size_t i = 0; i < n; ++i) shift += there.r[i] * there.r[i] - newton.weights()[i];
  shift /= static_cast<double>(n);
  const double unit = frame.scale;
  for (std::size_t i = 0; i < n; ++i) {
    const double volume = newton.cells().volumes[i];
    made.weights.push_back(unit * unit * (newton.weights()[i] + shift));
    made.volumes.push_back(unit * unit * unit * volume);
    made.sphericity.push_back(std::cbrt(36 * std::numbers::pi * volume * volume) /
                              newton.cells().surfaces[i]);
  }
  return made;
}

Spheres<dynamic> with_weights(const Spheres<dynamic>& spheres, std::span<const double> weights) {
  Spheres<dynamic> made = spheres;
  if (weights.empty() || spheres.empty()) return made;
  const double least = *std::ranges::min_element(weights), smallest = *std::ranges::min_element(spheres.r);
  for (std::size_t i = 0; i < made.size(); ++i)
    made.r[i] = std::sqrt(weights[i] - least + smallest * smallest);
  return made;
}

}  // namespace bernal
