#include <algorithm>
#include <cmath>
#include <ranges>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"
#include "core/order.hpp"
#include "predict/compositions.hpp"
#include "predict/search.hpp"

namespace bernal {
namespace {

constexpr int starts_each_population = 4;
constexpr int most_evaluations = 2000;

class Search {
 public:
  Search(const MixtureOf& mixture, int populations, const SearchOptions& options)
      : mixture_(mixture), populations_(populations), options_(options) {}

  Optimum run() {
    std::vector<std::vector<double>> starts;
    if (options_.from.empty()) {
      for (int k = 0; k <= starts_each_population * populations_; ++k)
        starts.push_back(predict::even_composition(k, populations_));
    } else {
      starts.push_back(predict::shares_at(predict::place_of(options_.from)));
    }

    std::vector<predict::Place> ends;
    const int rods = predict::few_rods(options_.rods);
    for (const std::vector<double>& from : starts) {
      evaluator_.fraction = static_cast<double>(ends.size()) / static_cast<double>(starts.size() + 1);
      evaluator_.activity =
          "start " + std::to_string(ends.size() + 1) + " of " + std::to_string(starts.size());
      ends.push_back(settled({from, value(from, rods)}, 0.2, 1e-6, rods));
      if (evaluator_.stopped()) break;
    }
    std::ranges::stable_sort(ends, std::greater(), &predict::Place::value);
    Optimum optimum;
    std::vector<double> values;
    for (const predict::Place& end : ends) values.push_back(end.value);
    predict::set_certainty(optimum, values, predict::same_end);
    optimum.shares = refined(ends);
    optimum.prediction = predict_packing_fraction(*mixture_(optimum.shares), options_.rods);
    optimum.evaluations = evaluator_.evaluations + 1;
    optimum.cancelled = evaluator_.stopped();
    return optimum;
  }

 private:
  /// The best of a few ends with all rods, because the number of rods can change which is best.
  std::vector<double> refined(const std::vector<predict::Place>& ends) {
    evaluator_.activity = "refining";
    predict::Place best{ends.front().x, -1};
    for (const predict::Place& end : ends | std::views::take(predict::ends_to_refine)) {
      if (end.value < ends.front().value - 1e-3 || evaluator_.stopped()) continue;
      const predict::Place fine = settled({end.x, value(end.x, options_.rods)}, 0.01, 1e-7, options_.rods);
      if (fine.value > best.value) best = fine;
    }
    leave_out_idle(best);
    return best.x;
  }

  /// Drops a population with a negligible share if that does not lower the packing fraction.
  void leave_out_idle(predict::Place& best) {
    for (std::size_t k = 0; k < best.x.size(); ++k) {
      if (best.x[k] == 0 || best.x[k] > 1e-3) continue;
      predict::Place without = best;
      without.x[k] = 0;
      for (double& share : without.x) share /= 1 - best.x[k];
      without.value = value(without.x, options_.rods);
      if (without.value >= best.value - 1e-7) best = without;
    }
  }

  /// Climbs until two climbs in a row, one along either parametrisation of the simplex, gain nothing: at a
  /// kink or a face one Nelder-Mead simplex can shrink where the other does not.
  predict::Place settled(predict::Place best, double step, double tolerance, int rods) {
    int idle = 0;
    for (bool backward = false; idle < 2 && !evaluator_.stopped(); backward = !backward) {
      const predict::Objective phi = [&](std::span<const double> u) {
        return value(predict::shares_at(u, backward), rods);
      };
      const predict::Place end =
          predict::climb(phi, predict::place_of(best.x, backward), {step, 0.1 * tolerance, most_evaluations},
                         [this] { return evaluator_.stopped(); });
      const double gain = end.value - best.value;
      if (gain > 0) best = {predict::shares_at(end.x, backward), end.value};
      idle = gain > tolerance ? 0 : idle + 1;
      step = std::max(0.25 * step, 0.01);
    }
    return best;
  }

  double value(const std::vector<double>& shares, int rods) {
    return evaluator_.phi(*mixture_(shares), rods);
  }

  const MixtureOf& mixture_;
  int populations_;
  const SearchOptions& options_;
  predict::Evaluator evaluator_{options_.monitor};
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
  // In a fixed order and scale: the largest first.
  const std::vector<std::uint32_t> order = largest_first(radii);
  std::vector<double> sizes;
  for (const std::size_t i : order) sizes.push_back(radii[i] / radii[order.front()]);
  predict::require_few_enough(1 / sizes.back(), options.rods);

  const MixtureOf mixture = [&](std::span<const double> shares) {
    return predict::mixture_of(sizes, shares);
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
