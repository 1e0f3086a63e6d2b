#include "cost/rounds.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal::cost {
namespace {

/// The same for one number of settings, so that a run that goes on does so in the same order.
std::vector<std::size_t> order_of_round(std::size_t settings, std::size_t round) {
  std::vector<std::size_t> order(settings);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(round / 2);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random() % k]);
  if (round % 2 == 1) std::ranges::reverse(order);
  return order;
}

/// Time for what has still to be measured, and who is told of it.
class Budget {
 public:
  Budget(const RoundOptions& options, std::size_t trials) : options_(options), trials_(trials) {}

  double left() const { return options_.budget - watch_.seconds(); }
  void told_of(std::size_t done) { done_ = done; }
  Monitor monitor(const std::string& name) const {
    return {[this, name](const Progress& progress) {
              const double of_trials = (static_cast<double>(done_) + std::max(0.0, progress.fraction)) /
                                       static_cast<double>(std::max<std::size_t>(1, trials_));
              const double of_time = watch_.seconds() / options_.budget;
              options_.monitor.report(
                  {"cost", std::min(1.0, std::max(of_trials, of_time)),
                   fmt::format("run {} of {}, {}: {}", done_ + 1, trials_, name, progress.detail)});
            },
            options_.monitor.cancelled};
  }

 private:
  const RoundOptions& options_;
  const Stopwatch watch_;
  std::size_t trials_, done_ = 0;
};

}  // namespace

int threads_of(int threads) {
  return threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
}

Rounds interleaved(const std::vector<Setting>& settings, TrialRecord& record, const RoundOptions& options) {
  const int threads = threads_of(options.threads);
  Rounds rounds;
  std::size_t missing = 0;
  // What was cut off with one seed is not run with another one, unless it may take longer now.
  const auto too_slow = [&](const Setting& setting) {
    return std::ranges::any_of(options.seeds, [&](std::uint64_t seed) {
      const Trial* trial = record.find(setting, seed, threads);
      return trial && trial->cut_off && std::min(options.limit, options.budget) < 1.5 * trial->seconds;
    });
  };
  const auto measured = [&](const Setting& setting, std::uint64_t seed) {
    const Trial* trial = record.find(setting, seed, threads);
    return (trial && !trial->cut_off) || too_slow(setting);
  };
  for (const Setting& setting : settings)
    for (const std::uint64_t seed : options.seeds) missing += !measured(setting, seed);
  Budget budget(options, missing);
  for (const Setting& setting : settings) rounds.series.push_back({&setting});
  for (std::size_t round = 0; round < options.seeds.size(); ++round) {
    for (const std::size_t k : order_of_round(settings.size(), round)) {
      const Setting& setting = settings[k];
      std::string& refused = rounds.series[k].refused;
      if (!refused.empty() || rounds.series[k].unfair || measured(setting, options.seeds[round])) continue;
      rounds.cancelled = rounds.cancelled || options.monitor.stop();
      rounds.out_of_time = rounds.out_of_time || !(budget.left() > 0);
      if (rounds.cancelled || rounds.out_of_time) break;
      try {
        const Trial trial = run_trial(setting.scene, {.seed = options.seeds[round],
                                                      .threads = threads,
                                                      .limit = std::min(options.limit, budget.left()),
                                                      .meant = setting.meant.get(),
                                                      .monitor = budget.monitor(setting.name)});
        rounds.cancelled = trial.outcome == Outcome::cancelled && !trial.cut_off;
        // That it is slower than what happened to be left of the time says nothing.
        rounds.out_of_time = trial.cut_off && !(budget.left() > 0) && trial.seconds < 0.9 * options.limit;
        if (rounds.cancelled || rounds.out_of_time) break;
        if (trial.cut_off && trial.seconds < options.fair) {
          rounds.series[k].unfair = true;
          continue;
        }
        record.add(setting, trial);
        ++rounds.made;
      } catch (const Error& error) {
        if (!options.pass_over_refused || error.code() == ErrorCode::cannot_write) throw;
        refused = error.what();
      }
      budget.told_of(rounds.made);
    }
  }
  for (Series& series : rounds.series)
    for (const std::uint64_t seed : options.seeds)
      if (const Trial* trial = record.find(*series.setting, seed, threads)) series.trials.push_back(*trial);
  return rounds;
}

Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), 0.5 * (values.back() - values.front())};
}

}  // namespace bernal::cost
