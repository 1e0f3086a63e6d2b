#include "predict/compositions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/core/error.hpp"

namespace bernal::predict {
namespace {

/// Largest error from the number of rods that may count as density.
constexpr double tolerated_error = 1e-4;

}  // namespace

std::vector<double> shares_at(std::span<const double> u, bool backward) {
  std::vector<double> shares;
  double rest = 1;
  for (const double part : u) {
    shares.push_back(part * rest);
    rest -= shares.back();
  }
  shares.push_back(std::max(rest, 0.0));
  if (backward) std::ranges::reverse(shares);
  return shares;
}

std::vector<double> place_of(std::vector<double> shares, bool backward) {
  if (backward) std::ranges::reverse(shares);
  double rest = std::accumulate(shares.begin(), shares.end(), 0.0);
  shares.pop_back();
  for (double& share : shares) {
    const double part = rest > 0 ? std::clamp(share / rest, 0.0, 1.0) : 0.0;
    rest -= share;
    share = part;
  }
  return shares;
}

std::vector<double> even_point(int k, int dimensions) {
  double root = 2;
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1.0 / (dimensions + 1));
  std::vector<double> point;
  for (int j = 1; j <= dimensions; ++j) {
    const double along = 0.5 + k * std::pow(root, -j);
    point.push_back(along - std::floor(along));
  }
  return point;
}

std::vector<double> even_composition(int k, int populations) {
  std::vector<double> u = even_point(k, populations - 1);
  for (int j = 0; j < populations - 1; ++j) {
    const double further = populations - 1 - j;
    double& v = u[static_cast<std::size_t>(j)];
    v = k == 0 ? 1 / (further + 1) : 1 - std::pow(v, 1 / further);
  }
  return shares_at(u);
}

std::unique_ptr<SizeDistribution> mixture_of(std::span<const double> radii, std::span<const double> shares) {
  std::vector<double> of, amounts;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    if (!(shares[k] > 0)) continue;
    if (!of.empty() && of.back() == radii[k]) {
      amounts.back() += shares[k];
    } else {
      of.push_back(radii[k]);
      amounts.push_back(shares[k]);
    }
  }
  return make_classes(std::move(of), std::move(amounts), Basis::volume);
}

void set_certainty(Optimum& optimum, std::span<const double> ends, double same) {
  const auto [worst, best] = std::ranges::minmax(ends);
  optimum.starts = static_cast<int>(ends.size());
  optimum.agreeing = static_cast<int>(
      std::ranges::count_if(ends, [&, most = best](double end) { return end >= most - same; }));
  optimum.spread = best - worst;
}

void require_few_enough(double ratio, int rods) {
  if (!(ratio <= widest_ratio(rods)))
    throw Error(ErrorCode::bad_argument,
                std::to_string(rods) + " rods stand for sizes no farther apart than 1 : " +
                    std::to_string(static_cast<int>(widest_ratio(rods))) + "; more rods reach farther");
}

void require_limits(double min, double max, int rods) {
  if (!(min > 0 && min < max && std::isfinite(max)))
    throw Error(ErrorCode::bad_argument,
                "sizes are searched for from a positive smallest to a larger, finite largest one");
  require_few_enough(max / min, rods);
}

int few_rods(int rods) { return std::min(rods, std::max(1000, rods / 4)); }

double Evaluator::phi(const SizeDistribution& sizes, int rods) {
  report();
  ++evaluations;
  const Prediction p = predict_packing_fraction(sizes, rods);
  densest_ = std::max(densest_, p.phi);
  return p.phi - std::max(0.0, p.error - tolerated_error);
}

bool Evaluator::stopped() {
  stopped_ = stopped_ || monitor_.stop();
  return stopped_;
}

void Evaluator::report() {
  const auto now = std::chrono::steady_clock::now();
  if (!monitor_.on_progress || now - reported_ < std::chrono::milliseconds(50)) return;
  reported_ = now;
  const std::string detail = activity + ", densest so far " + std::to_string(densest_);
  monitor_.report({"search", fraction, detail});
}

}  // namespace bernal::predict
