#include "figures/zhao.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal::figures {
namespace {

constexpr int as_many_as_printed = 10'000;
constexpr int counts_of_reference[] = {100, 300, 1000, 3000, 10'000};
constexpr int counts_of_fast[] = {1000, 3000, 10'000, 30'000, 100'000};
constexpr int beyond = 30'000;  ///< the shortest period alone is affordable there by the published loop
constexpr int counted_for_table = 2000, seeds_of_table = 3;
constexpr int most_seeds = 8;
constexpr double loose_phi0 = 0.75;

/// More seeds where few spheres scatter.
int seeds_for(int spheres, int most) { return std::clamp(most / 3 / spheres, 1, most_seeds); }

double sweeps_between(const ZhaoRun& run) {
  const double decades = std::log10(static_cast<double>(run.spheres));
  return run.period > 0 ? run.period : Relax{}.alpha * decades * decades;
}

PackingTask task_of(const ZhaoRun& run) {
  const ZhaoSizes& of = zhao_sizes()[run.sizes];
  PackingTask task;
  Scene& scene = task.scene;
  scene.container = PeriodicBox{};
  scene.sizes = of.sizes;
  scene.draw = of.draw;
  scene.seed = run.seed;
  scene.target.count = run.spheres;
  Relax relax{.phi0 = run.phi0, .method = run.method};
  if (run.period > 0) relax.period = run.period;
  scene.stages = {relax};
  task.alone = run.method == RelaxMethod::fast;
  task.cost = (task.alone ? 0.015 : 1) * of.cost * run.spheres * sweeps_between(run);
  return task;
}

/// All that the figures and the table need, each once.
std::vector<ZhaoRun> wanted(const FigureOptions& options) {
  const int most = options.spheres > 0 ? options.spheres : as_many_as_printed;
  std::vector<ZhaoRun> runs;
  const auto add = [&](ZhaoRun run, int seeds) {
    for (int k = 0; k < seeds; ++k) {
      run.seed = options.seed + static_cast<std::uint64_t>(k);
      if (std::ranges::find(runs, run) == runs.end()) runs.push_back(run);
    }
  };
  for (const int n : counts_of_reference) {  // figures 5 and 8
    if (n > most) break;
    for (const int period : {0, fixed_periods[0], fixed_periods[1]})
      add({.period = period, .spheres = n}, seeds_for(n, most));
    add({.phi0 = loose_phi0, .spheres = n}, 1);
  }
  if (most >= as_many_as_printed) add({.period = fixed_periods[0], .spheres = beyond}, 1);
  for (const int n : counts_of_fast)
    if (options.spheres == 0 || n <= most) add({.method = RelaxMethod::fast, .spheres = n}, 1);

  for (std::size_t row = 0; row < zhao_sizes().size(); ++row) {  // table 2, figures 9 to 12
    const int seeds = most < counted_for_table ? 1 : seeds_of_table;
    add({.sizes = row, .spheres = std::min(counted_for_table, most)}, seeds);
    if (options.pack) add({.sizes = row, .spheres = most}, 1);
    add({.sizes = row, .method = RelaxMethod::fast, .spheres = most}, seeds);
  }
  return runs;
}

std::string csv_of(const ZhaoResults& results) {
  std::string csv = "sizes,loop,period,phi0,spheres,seed,phi,coordination,seconds";
  for (const double gap : counted_gaps) csv += fmt::format(",coordination_at_{:g}", gap);
  csv += "\n";
  for (std::size_t k = 0; k < results.runs.size(); ++k) {
    const ZhaoRun& run = results.runs[k];
    const DonePacking& done = results.done[k];
    csv += fmt::format("{},{},{},{},{},{},{:.6f},{:.4f},{:.3f}", zhao_sizes()[run.sizes].name,
                       run.method == RelaxMethod::fast ? "fast" : "reference",
                       run.period > 0 ? std::to_string(run.period) : "adaptive", run.phi0, run.spheres,
                       run.seed, done.phi, done.coordination[usual_gap], done.seconds);
    for (const double z : done.coordination) csv += fmt::format(",{:.4f}", z);
    csv += "\n";
  }
  return csv;
}

template <class Value>
MeanOfSeeds mean_over(const std::vector<const DonePacking*>& packings, const Value& value) {
  std::vector<double> values;
  for (const DonePacking* each : packings) values.push_back(value(*each));
  return mean_of(values);
}

}  // namespace

const std::vector<ZhaoSizes>& zhao_sizes() {
  static const std::vector<ZhaoSizes> all = {
      {"equal", Constant{1}, Draw::random, 0.646, 5.72, 1, 9},
      {"radii 1 and 0.5", Classes{{1, 0.5}, {1, 1}}, Draw::quantiles, 0.665, 5.24, 1.3, 10},
      {"lognormal 0.3", Lognormal{.median = 1, .sigma = printed_sigma}, Draw::random, 0.644, 5.64, 2.2, 11},
      {"arbitrary",
       // Their figure 2, which has the data, is not in the text: a reading of what it must show, as in
       // data/scenes/relax_arbitrary.toml.
       Tabulated{{0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.4, 2.8, 3.2, 3.6, 4.0},
                 {0.0, 0.75, 1.0, 0.93, 0.79, 0.65, 0.53, 0.43, 0.34, 0.27, 0.17, 0.10, 0.06, 0.03, 0.0}},
       Draw::random, 0.692, 4.24, 2.3, 12},
      {"lognormal 0.212", Lognormal{.median = 1, .sigma = drawn_sigma}, Draw::random, {}, {}, 1.6, 0}};
  return all;
}

std::vector<const DonePacking*> ZhaoResults::of(ZhaoRun run) const {
  std::vector<const DonePacking*> found;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    run.seed = runs[k].seed;
    if (runs[k] == run) found.push_back(&done[k]);
  }
  return found;
}

std::vector<int> ZhaoResults::counts(ZhaoRun run) const {
  std::vector<int> found;
  for (const ZhaoRun& each : runs) {
    run.seed = each.seed;
    run.spheres = each.spheres;
    if (each == run) found.push_back(each.spheres);
  }
  std::ranges::sort(found);
  const auto twice = std::ranges::unique(found);
  found.erase(twice.begin(), twice.end());
  return found;
}

MeanOfSeeds phi_of(const std::vector<const DonePacking*>& packings) {
  return mean_over(packings, [](const DonePacking& p) { return p.phi; });
}
MeanOfSeeds coordination_of(const std::vector<const DonePacking*>& packings) {
  return mean_over(packings, [](const DonePacking& p) { return p.coordination[usual_gap]; });
}
MeanOfSeeds seconds_of(const std::vector<const DonePacking*>& packings) {
  return mean_over(packings, [](const DonePacking& p) { return p.seconds; });
}

/// Zhao, Li & Liu (2007): figures 1, 2, 5, 8 and 9 to 12, and table 2.
Files zhao_2007(const FigureOptions& options) {
  const Stopwatch watch;
  ZhaoResults results{.runs = wanted(options), .done = {}};
  std::vector<PackingTask> tasks;
  for (const ZhaoRun& run : results.runs) tasks.push_back(task_of(run));
  std::optional<std::vector<DonePacking>> done = pack_all(tasks, "zhao2007", options);
  if (!done) return {};
  results.done = std::move(*done);
  for (const DonePacking& each : results.done)
    if (!is_packed(each.packing.outcome))
      throw Error(ErrorCode::bad_argument, "a relaxation for zhao2007 did not converge");

  DrawnSizes drawn = zhao_drawn_sizes(options.seed);
  Files files = {{"zhao2007.md", zhao_page(results, drawn, watch.seconds())},
                 {"zhao2007.csv", csv_of(results)}};
  for (Files more : {std::move(drawn.files), zhao_pictures(results)})
    for (File& file : more) files.push_back(std::move(file));
  return files;
}

}  // namespace bernal::figures
