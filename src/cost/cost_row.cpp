#include "cost/cost_row.hpp"

#include <algorithm>
#include <cmath>

namespace bernal::cost {

CostRow row_of(const Series& series, double wall_deviation, double mean_radius) {
  CostRow row;
  row.runs = static_cast<int>(series.trials.size());
  row.certified = true;
  row.outcome = Outcome::converged;
  const auto over = [&](auto value) {
    std::vector<double> all;
    for (const Trial& trial : series.trials)
      if (!trial.cut_off) all.push_back(value(trial));
    if (all.empty()) all.push_back(0);
    return spread_of(std::move(all));
  };
  const auto over_some = [&](std::optional<double> Trial::*value) -> std::optional<double> {
    std::vector<double> all;
    for (const Trial& trial : series.trials)
      if (trial.*value) all.push_back(*(trial.*value));
    return all.size() < series.trials.size() ? std::nullopt : std::optional(spread_of(std::move(all)).median);
  };
  for (const Trial& trial : series.trials) {
    row.slower = row.slower || trial.cut_off;
    row.certified = row.certified && trial.certified;
    if (trial.outcome >= row.outcome) row.reason = trial.reason;
    row.outcome = std::max(row.outcome, trial.outcome);
    if (!trial.cut_off) row.phi_of_seed.push_back(trial.packing_fraction);
  }
  const Spread phi = over([](const Trial& t) { return t.packing_fraction; });
  const Spread seconds = over([](const Trial& t) { return t.cpu_seconds; });
  row.phi = phi.median;
  row.phi_scatter = phi.half_width;
  row.seconds = seconds.median;
  row.seconds_scatter = seconds.half_width;
  row.wall_seconds = over([](const Trial& t) { return t.seconds; }).median;
  if (row.slower)
    for (const Trial& trial : series.trials) row.seconds = std::max(row.seconds, trial.cpu_seconds);
  row.prepare_seconds = over([](const Trial& t) { return t.prepare_seconds; }).median;
  row.memory_bytes = over_some(&Trial::peak_bytes);
  row.early_overlap = over([](const Trial& t) { return t.early_overlap; }).median;
  row.max_overlap = over([](const Trial& t) { return t.max_overlap; }).median;
  row.held_from = over_some(&Trial::held_from);
  if (row.held_from)  // a decade: nothing lies between two of them
    for (const Trial& trial : series.trials) row.held_from = std::max(row.held_from, trial.held_from);
  row.contact_ratio = over_some(&Trial::contact_ratio);
  row.coordination = over([](const Trial& t) { return t.coordination; }).median;
  row.size_scale = over([](const Trial& t) { return t.size_scale; }).median;
  row.spheres = static_cast<double>(series.trials.front().spheres);
  row.wall_error =
      std::max(wall_deviation / mean_radius, over([](const Trial& t) { return t.protrusion; }).median);
  row.hash = series.trials.front().hash;
  row.own_phi = series.trials.front().packing_fraction;
  row.packed_phi = series.trials.front().packed_fraction;
  row.own_seconds = series.trials.front().cpu_seconds;
  return row;
}

Difference difference_of(const CostRow& row, const CostRow& to) {
  const std::size_t seeds = std::min(row.phi_of_seed.size(), to.phi_of_seed.size());
  if (seeds == 0) return {};
  std::vector<double> all;
  for (std::size_t k = 0; k < seeds; ++k) all.push_back(row.phi_of_seed[k] - to.phi_of_seed[k]);
  const auto n = static_cast<double>(seeds);
  Difference difference{.least = std::ranges::min(all), .most = std::ranges::max(all)};
  for (const double d : all) difference.mean += d / n;
  double squares = 0;
  for (const double d : all) squares += (d - difference.mean) * (d - difference.mean);
  if (seeds > 1) difference.error = std::sqrt(squares / (n - 1) / n);
  return difference;
}

bool is_no_loss(const CostRow& row, const CostRow& to) {
  const Difference difference = difference_of(row, to);
  const double loss = -difference.mean;
  return loss <= good_enough || (loss <= most_tolerated && loss <= difference.error.value_or(0));
}

bool are_same_spheres(const CostRow& a, const CostRow& b) {
  return !a.slower && !b.slower && a.hash == b.hash && a.phi_of_seed == b.phi_of_seed;
}

}  // namespace bernal::cost
