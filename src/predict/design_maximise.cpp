#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <ranges>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"
#include "predict/search.hpp"

namespace bernal {
namespace {

/// Starts that end this near to the best found the same packing fraction.
constexpr double same = 1e-5;
/// Of the rods' number; what is beyond it does not count as density.
constexpr double tolerated_error = 1e-4;
constexpr int starts_each_population = 4;
constexpr int to_refine = 3;
constexpr int most_evaluations = 2000;

/// x_k = u_k (1 - x_1 - … - x_(k-1)), the last is what remains; `backward` begins at the other end.
std::vector<double> shares_at(std::span<const double> u, bool backward = false) {
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

/// The place in the cube that shares of any scale have.
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

/// Where the k-th search begins: the 0th at equal shares, the others spread evenly over the simplex. The
/// points k / phi_d^j mod 1, where phi_d^(d+1) = phi_d + 1, fill a cube (Roberts 2018); u = 1 - v^(1/m) with
/// m further shares makes them even on the simplex.
std::vector<double> start(int k, int populations) {
  const int variables = populations - 1;
  double root = 2;
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1.0 / (variables + 1));
  std::vector<double> u;
  for (int j = 1; j <= variables; ++j) {
    const double further = populations - j;
    const double along = 0.5 + k * std::pow(root, -j);
    u.push_back(k == 0 ? 1 / (further + 1) : 1 - std::pow(along - std::floor(along), 1 / further));
  }
  return shares_at(u);
}

struct Composition {
  std::vector<double> shares;
  double value;
};

class Search {
 public:
  Search(const MixtureOf& mixture, int populations, const SearchOptions& options)
      : mixture_(mixture), populations_(populations), options_(options) {}

  Optimum run() {
    std::vector<std::vector<double>> starts;
    if (options_.from.empty()) {
      for (int k = 0; k <= starts_each_population * populations_; ++k)
        starts.push_back(start(k, populations_));
    } else {
      starts.push_back(shares_at(place_of(options_.from, false)));
    }
    all_ = static_cast<int>(starts.size());

    std::vector<Composition> ends;
    for (const std::vector<double>& from : starts) {
      ends.push_back(settled({from, value(from, few_rods())}, 0.2, 1e-6, few_rods()));
      ++done_;
      if (stopped()) break;
    }
    std::ranges::stable_sort(ends, std::greater(), &Composition::value);
    Optimum optimum;
    optimum.starts = static_cast<int>(ends.size());
    optimum.agreeing = static_cast<int>(std::ranges::count_if(
        ends, [&](const Composition& end) { return end.value >= ends.front().value - same; }));
    optimum.spread = ends.front().value - ends.back().value;
    optimum.shares = refined(ends);
    optimum.prediction = predict_packing_fraction(*mixture_(optimum.shares), options_.rods);
    optimum.evaluations = evaluations_ + 1;
    optimum.cancelled = stopped_;
    return optimum;
  }

 private:
  int few_rods() const { return std::min(options_.rods, std::max(1000, options_.rods / 4)); }

  /// The best with all rods: of the best few, for which is best can depend on their number.
  std::vector<double> refined(const std::vector<Composition>& ends) {
    Composition best{ends.front().shares, -1};
    for (const Composition& end : ends | std::views::take(to_refine)) {
      if (end.value < ends.front().value - 1e-3 || stopped()) continue;
      const Composition fine =
          settled({end.shares, value(end.shares, options_.rods)}, 0.01, 1e-7, options_.rods);
      if (fine.value > best.value) best = fine;
    }
    return best.shares;
  }

  bool stopped() {
    stopped_ = stopped_ || options_.monitor.stop();
    return stopped_;
  }

  /// Climbs until neither of two climbs, one along either cut of the simplex, gains: at a kink or a face one
  /// simplex of Nelder and Mead can shrink where another does not.
  Composition settled(Composition best, double step, double tolerance, int rods) {
    int idle = 0;
    for (bool backward = false; idle < 2 && !stopped(); backward = !backward) {
      const predict::Objective phi = [&](std::span<const double> u) {
        return value(shares_at(u, backward), rods);
      };
      const predict::Place end =
          predict::climb(phi, place_of(best.shares, backward), {step, 0.1 * tolerance, most_evaluations},
                         [this] { return stopped(); });
      const double gain = end.value - best.value;
      if (gain > 0) best = {shares_at(end.x, backward), end.value};
      idle = gain > tolerance ? 0 : idle + 1;
      step = std::max(0.25 * step, 0.01);
    }
    return best;
  }

  double value(const std::vector<double>& shares, int rods) {
    report();
    ++evaluations_;
    const Prediction p = predict_packing_fraction(*mixture_(shares), rods);
    best_ = std::max(best_, p.phi);
    return p.phi - std::max(0.0, p.error - tolerated_error);
  }

  void report() {
    const auto now = std::chrono::steady_clock::now();
    if (!options_.monitor.on_progress || now - reported_ < std::chrono::milliseconds(50)) return;
    reported_ = now;
    const std::string detail = "start " + std::to_string(std::min(done_ + 1, all_)) + " of " +
                               std::to_string(all_) + ", densest " + std::to_string(best_);
    options_.monitor.report({"search", static_cast<double>(done_) / (all_ + 1), detail});
  }

  const MixtureOf& mixture_;
  int populations_;
  const SearchOptions& options_;
  int all_ = 0, done_ = 0, evaluations_ = 0;
  double best_ = 0;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point reported_{};
};

void require(bool holds, const std::string& message) {
  if (!holds) throw Error(ErrorCode::bad_argument, message);
}

}  // namespace

Optimum maximise_packing_fraction(const MixtureOf& mixture, int populations, const SearchOptions& options) {
  require(populations >= 2 && populations <= most_populations_to_mix,
          "a composition is searched for of 2 to 6 populations, not of " + std::to_string(populations));
  require(options.rods >= 2, "a prediction needs at least 2 rods, not " + std::to_string(options.rods));
  if (!options.from.empty()) {
    double sum = 0;
    for (const double share : options.from) {
      require(share >= 0, "the shares to begin at must not be negative");
      sum += share;
    }
    require(options.from.size() == static_cast<std::size_t>(populations) && sum > 0 && std::isfinite(sum),
            "the shares to begin at must be one for each population, finite and not all zero");
  }
  return Search(mixture, populations, options).run();
}

Optimum maximise_packing_fraction(std::span<const double> radii, const SearchOptions& options) {
  require(std::ranges::all_of(radii, [](double r) { return r > 0 && std::isfinite(r); }),
          "sizes must be positive and finite");
  require(!radii.empty(), "a composition is searched for of 2 to 6 populations, not of 0");
  // In one order and to one scale, whatever the caller's: the largest first.
  std::vector<std::size_t> order(radii.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return radii[i]; });
  std::vector<double> sizes;
  for (const std::size_t i : order) sizes.push_back(radii[i] / radii[order.front()]);
  require(sizes.back() > 1e-60, "the sizes are too far apart");

  const MixtureOf mixture = [&](std::span<const double> shares) {
    std::vector<double> of, amounts;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (!(shares[k] > 0)) continue;
      if (!of.empty() && of.back() == sizes[k]) {
        amounts.back() += shares[k];
      } else {
        of.push_back(sizes[k]);
        amounts.push_back(shares[k]);
      }
    }
    return make_classes(std::move(of), std::move(amounts), Basis::volume);
  };
  SearchOptions ordered = options;
  if (ordered.from.size() == order.size())
    for (std::size_t k = 0; k < order.size(); ++k) ordered.from[k] = options.from[order[k]];
  const Optimum found = maximise_packing_fraction(mixture, static_cast<int>(sizes.size()), ordered);
  Optimum optimum = found;
  for (std::size_t k = 0; k < order.size(); ++k) optimum.shares[order[k]] = found.shares[k];
  return optimum;
}

}  // namespace bernal
