#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/predict/design.hpp"
#include "predict/compositions.hpp"

namespace bernal {
namespace {

/// Classes that represent all bins in the search: with one class a bin the error is 0.001, with 128 in all at
/// most 1e-4.
constexpr int classes_in_search = 128;
/// Starts that end this close to the best found the same density, as far as classes can represent bins.
constexpr double same_for_classes = 1e-4;
/// Shares of the volume: the first amount moved between bins, and the last.
constexpr double first_amount = 0.08, last_amount = 5e-4;

using Shares = std::vector<double>;

class DensitySearch {
 public:
  DensitySearch(double min, double max, const SearchOptions& options)
      : min_(min), max_(max), width_(std::log(max / min)), options_(options) {}

  DensestDensity run(int most_bins) {
    DensestDensity answer;
    const double q = best_power_law(answer);
    const Shares peaks = spread_peaks(most_bins);
    Shares best;
    for (int bins = 2; bins <= most_bins; bins *= 2) {
      evaluator_.activity = std::to_string(bins) + " bins";
      std::vector<Shares> starts = {power_law(q, bins), gathered(peaks, bins),
                                    Shares(static_cast<std::size_t>(bins), 1.0 / bins)};
      if (!best.empty()) starts.push_back(split(best));
      std::vector<double> ends;
      double densest = -1;
      for (Shares& from : starts) {
        const double end = settle(from);
        ends.push_back(end);
        if (end > densest) {
          densest = end;
          best = from;
        }
        evaluator_.fraction = std::min(1.0, evaluator_.fraction + 0.7 * bins / (8.0 * most_bins));
      }
      predict::set_certainty(answer.optimum, ends, same_for_classes);
      answer.optimum.prediction = predict_packing_fraction(*sieve(best), options_.rods);
      answer.levels.push_back({bins, answer.optimum.prediction.phi});
    }
    answer.radii = edges(most_bins);
    answer.optimum.shares = best;
    answer.optimum.evaluations = evaluator_.evaluations;
    answer.optimum.cancelled = evaluator_.stopped();
    return answer;
  }

 private:
  int rods() const { return std::min(options_.rods, std::max(1000, options_.rods / 8)); }

  double radius(double along) const { return min_ * std::exp(along * width_); }

  std::vector<double> edges(int bins) const {
    std::vector<double> radii;
    for (int k = 0; k <= bins; ++k) radii.push_back(radius(static_cast<double>(k) / bins));
    return radii;
  }

  std::unique_ptr<SizeDistribution> sieve(const Shares& shares) const {
    std::vector<double> passing = {0};
    for (const double share : shares) passing.push_back(passing.back() + share);
    return make_sieve(edges(static_cast<int>(shares.size())), passing);
  }

  double phi(const Shares& shares) {
    const auto bins = static_cast<int>(shares.size());
    const int each = std::max(1, classes_in_search / bins);
    std::vector<double> radii, amounts;
    for (int k = 0; k < bins; ++k)
      for (int i = 0; i < each && shares[static_cast<std::size_t>(k)] > 0; ++i) {
        radii.push_back(radius((k + (i + 0.5) / each) / bins));
        amounts.push_back(shares[static_cast<std::size_t>(k)] / each);
      }
    return evaluator_.phi(*make_classes(std::move(radii), std::move(amounts), Basis::volume), rods());
  }

  /// Moves volume between bins as long as that gains, then smaller amounts.
  double settle(Shares& shares) {
    double best = phi(shares);
    for (double amount = first_amount; amount > last_amount; amount /= 2)
      for (bool gains = true; gains && !evaluator_.stopped();) {
        gains = false;
        for (std::size_t from = 0; from < shares.size(); ++from)
          for (std::size_t to = 0; to < shares.size() && shares[from] > 0; ++to) {
            if (to == from) continue;
            Shares moved = shares;
            moved[to] += std::min(amount, shares[from]);
            moved[from] = std::max(0.0, shares[from] - amount);
            if (const double end = phi(moved); end > best + 1e-7) {
              best = end;
              shares = moved;
              gains = true;
            }
          }
      }
    return best;
  }

  /// The same density with half the bin width.
  static Shares split(const Shares& shares) {
    Shares halves;
    for (const double share : shares) halves.insert(halves.end(), 2, 0.5 * share);
    return halves;
  }

  static Shares gathered(const Shares& fine, int bins) {
    Shares coarse(static_cast<std::size_t>(bins), 0.0);
    for (std::size_t k = 0; k < fine.size(); ++k) coarse[k * coarse.size() / fine.size()] += fine[k];
    return coarse;
  }

  /// The densest four sizes as peaks.
  Shares spread_peaks(int bins) {
    SearchOptions options;
    options.rods =
        std::min(options_.rods, std::max(options_.rods / 4, static_cast<int>(17 * std::exp(width_))));
    options.monitor.cancelled = [this] { return evaluator_.stopped(); };
    options.monitor.on_progress = [this](Progress progress) {
      progress.fraction *= 0.3;
      options_.monitor.report(progress);
    };
    const DensestSizes few = densest_sizes(min_, max_, 4, options);
    evaluator_.fraction = 0.3;
    Shares shares(static_cast<std::size_t>(bins), 0.0);
    for (std::size_t k = 0; k < few.radii.size(); ++k) {
      const double along = std::log(few.radii[k] / min_) / width_;
      shares[std::min(shares.size() - 1, static_cast<std::size_t>(std::max(0.0, along * bins)))] +=
          few.optimum.shares[k];
    }
    return shares;
  }

  Shares power_law(double q, int bins) const {
    Shares shares;
    for (int k = 0; k < bins; ++k)
      shares.push_back((std::expm1(q * width_ * (k + 1) / bins) - std::expm1(q * width_ * k / bins)) /
                       std::expm1(q * width_));
    return shares;
  }

  double best_power_law(DensestDensity& answer) {
    evaluator_.activity = "power laws";
    const auto loose = [&](double q) {
      return -evaluator_.phi(*make_fuller(max_, q, min_), predict::few_rods(options_.rods));
    };
    std::uintmax_t most = 40;
    answer.power_law_exponent = boost::math::tools::brent_find_minima(loose, 0.01, 3.0, 20, most).first;
    answer.power_law_phi =
        predict_packing_fraction(*make_fuller(max_, answer.power_law_exponent, min_), options_.rods).phi;
    return answer.power_law_exponent;
  }

  double min_, max_, width_;
  const SearchOptions& options_;
  predict::Evaluator evaluator_{options_.monitor};
};

}  // namespace

DensestDensity densest_density(double min, double max, int bins, const SearchOptions& options) {
  predict::require_limits(min, max, options.rods);
  if (bins < 2 || bins > 64 || (bins & (bins - 1)) != 0)
    throw Error(ErrorCode::bad_argument,
                "the bins of a density are 2, 4, 8, 16, 32 or 64, not " + std::to_string(bins));
  return DensitySearch(min, max, options).run(bins);
}

}  // namespace bernal
