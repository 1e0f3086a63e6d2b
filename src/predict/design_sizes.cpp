#include <algorithm>
#include <cmath>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"
#include "predict/compositions.hpp"
#include "predict/search.hpp"

namespace bernal {
namespace {

constexpr int starts = 9;
constexpr int most_evaluations_of_sizes = 4000;

/// Points are u: count - 1 for the composition, then count - 2 positions between the ends.
class SizesSearch {
 public:
  SizesSearch(double min, double max, int count, const SearchOptions& options)
      : min_(min), max_(max), count_(static_cast<std::size_t>(count)), options_(options) {}

  DensestSizes run() {
    const int rods = predict::few_rods(options_.rods);
    std::vector<predict::Place> ends;
    for (int k = 0; k < starts && !evaluator_.stopped(); ++k) {
      evaluator_.fraction = static_cast<double>(k) / (starts + 1);
      evaluator_.activity = std::to_string(count_) + " sizes";
      ends.push_back(settled(start(k), 0.1, 1e-6, rods));
    }
    if (ends.empty()) ends.push_back({start(0), 0});
    std::ranges::stable_sort(ends, std::greater(), &predict::Place::value);
    std::vector<double> values;
    for (const predict::Place& end : ends) values.push_back(end.value);
    predict::Place best = ends.front();
    best.value = -1;
    for (std::size_t k = 0;
         k < std::min<std::size_t>(predict::ends_to_refine, ends.size()) && !evaluator_.stopped(); ++k) {
      const predict::Place fine = settled(ends[k].x, 0.01, 1e-7, options_.rods);
      if (fine.value > best.value) best = fine;
    }

    DensestSizes answer = at(best.x);
    predict::set_certainty(answer.optimum, values, predict::same_end);
    answer.optimum.prediction = predict_packing_fraction(*mixture(best.x), options_.rods);
    answer.optimum.evaluations = evaluator_.evaluations + 1;
    answer.optimum.cancelled = evaluator_.stopped();
    return answer;
  }

 private:
  /// Even positions, each size with a third of the volume of the next larger; other starts are spread evenly.
  std::vector<double> start(int k) const {
    const auto n = static_cast<int>(count_);
    if (k > 0) return predict::even_point(k, 2 * n - 3);
    std::vector<double> shares;
    for (int i = 0; i < n; ++i) shares.push_back(std::pow(3, i));
    std::vector<double> u = predict::place_of(shares);
    for (int i = 1; i < n - 1; ++i) u.push_back(static_cast<double>(i) / (n - 1));
    return u;
  }

  DensestSizes at(std::span<const double> u) const {
    std::vector<std::pair<double, double>> sizes;
    std::vector<double> shares = predict::shares_at(u.first(count_ - 1));
    sizes.emplace_back(min_, shares.front());
    for (std::size_t i = 1; i + 1 < count_; ++i)
      sizes.emplace_back(std::clamp(min_ * std::pow(max_ / min_, u[count_ - 2 + i]), min_, max_), shares[i]);
    sizes.emplace_back(max_, shares.back());
    std::ranges::sort(sizes);
    DensestSizes of;
    for (const auto& [radius, share] : sizes) {
      of.radii.push_back(radius);
      of.optimum.shares.push_back(share);
    }
    return of;
  }

  std::unique_ptr<SizeDistribution> mixture(std::span<const double> u) const {
    const DensestSizes of = at(u);
    return predict::mixture_of(of.radii, of.optimum.shares);
  }

  /// Climbs again from its end until that gains nothing twice.
  predict::Place settled(const std::vector<double>& from, double step, double tolerance, int rods) {
    const predict::Objective phi = [&](std::span<const double> u) {
      return evaluator_.phi(*mixture(u), rods);
    };
    predict::Place best{from, phi(from)};
    for (int idle = 0; idle < 2 && !evaluator_.stopped();
         step = idle == 1 ? 0.05 : std::max(0.5 * step, 0.005)) {
      const predict::Place end =
          predict::climb(phi, best.x, {step, 0.1 * tolerance, most_evaluations_of_sizes},
                         [this] { return evaluator_.stopped(); });
      idle = end.value > best.value + tolerance ? 0 : idle + 1;
      if (end.value > best.value) best = end;
    }
    return best;
  }

  double min_, max_;
  std::size_t count_;
  const SearchOptions& options_;
  predict::Evaluator evaluator_{options_.monitor};
};

}  // namespace

DensestSizes densest_sizes(double min, double max, int count, const SearchOptions& options) {
  predict::require_limits(min, max, options.rods);
  if (count < 2 || count > most_populations_to_mix)
    throw Error(ErrorCode::bad_argument, "2 to 6 sizes are searched for, not " + std::to_string(count));
  return SizesSearch(min, max, count, options).run();
}

}  // namespace bernal
