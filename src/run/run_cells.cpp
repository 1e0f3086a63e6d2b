#include "run/run_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/measure/cell_weights.hpp"
#include "bernal/measure/local_packing.hpp"
#include "bernal/measure/size_comparison.hpp"
#include "core/parallel.hpp"
#include "measure/weighted_cells.hpp"
#include "plan/cell_sizes.hpp"
#include "plan/made_plan.hpp"
#include "work/effect_log.hpp"

namespace bernal {
namespace {

/// Spheres that a mean is taken over, where there are more than that: of the noise of one cell, a tenth of
/// its volume, they leave one per cent.
constexpr std::size_t spheres_a_mean = 100;
/// A round that brings the distribution less than this nearer is the last.
constexpr double worth_a_round = 0.002;
/// Of the packing fraction, with which a box that did not take all spheres is tried again, and how often.
constexpr double share_after_shrink = 0.98;
constexpr int most_shrinks = 8;
/// Volumes that differ by less are the same.
constexpr double same_volume = 1e-8;

std::vector<std::uint32_t> by_rank(const std::vector<double>& values) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return values[i]; });
  return order;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// What is lacking, as a factor of radii, over the logarithm of the wanted volume: straight between the means
/// over spheres next to each other in size.
class Correction {
 public:
  /// `wanted` ascend; `own` are the volumes of the cells of the spheres of these.
  Correction(const std::vector<double>& wanted, const std::vector<double>& own) {
    const std::size_t n = wanted.size();
    for (std::size_t first = 0, last = 0; first < n; first = last) {
      last = std::min(n, first + spheres_a_mean);
      if (n - last < spheres_a_mean / 2) last = n;
      while (last < n && wanted[last] == wanted[last - 1]) ++last;  // equal ones stay equal
      double asked = 0, there = 0, place = 0;
      for (std::size_t k = first; k < last; ++k) {
        asked += wanted[k];
        there += own[k];
        place += std::log(wanted[k]);
      }
      places_.push_back(place / static_cast<double>(last - first));
      logs_.push_back(std::log(asked / there) / 3);
    }
  }

  double factor(double volume) const {
    const double place = std::log(volume);
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(places_, place) - places_.begin());
    if (above == 0) return std::exp(logs_.front());
    if (above == places_.size()) return std::exp(logs_.back());
    const double share = (place - places_[above - 1]) / (places_[above] - places_[above - 1]);
    return std::exp(logs_[above - 1] + share * (logs_[above] - logs_[above - 1]));
  }

 private:
  std::vector<double> places_, logs_;
};

class CellRun {
 public:
  CellRun(const Plan& plan, const RunOptions& options)
      : plan_(plan), options_(options), stated_(stated_cells_of(plan.scene)) {
    volumes_ = stated_.volumes(static_cast<std::size_t>(*plan.scene.target.count));
    for (const double volume : volumes_)
      radii_.push_back(
          radius_in_cell(volume, volume_of(plan.domain) * plan.expected_packing_fraction / sum_of(volumes_)));
  }

  Packing found() {
    if (options_.checkpoints.resume && options_.checkpoints.tell)
      options_.checkpoints.tell("packings with cells of given volumes have no checkpoints; it starts anew");
    Packing last = pack();
    if (can_have_cells(last)) take(std::move(last));
    while (best_ && rounds_ < plan_.scene.cells->rounds) {
      correct_radii();
      Packing next = pack();
      ++rounds_;
      const double before = best_distance_;
      if (!can_have_cells(next)) break;
      take(std::move(next));
      if (best_distance_ > before - worth_a_round) break;
    }
    Packing packing = best_ ? std::move(*best_) : std::move(last);
    if (best_ && !stopped_) find_weights(packing);
    if (stopped_ && packing.outcome != Outcome::cancelled) {
      packing.outcome = Outcome::cancelled;
      packing.reason = "stopped by the user before the cells had their volumes: " + packing.reason;
    }
    state_scene(packing);
    packing.seconds = watch_.seconds();
    return packing;
  }

 private:
  /// Into a box of given size what fits: smaller spheres, where nobody asks how much of it they fill.
  Packing pack() {
    RunOptions options = options_;
    options.checkpoints = {};
    const bool may_shrink = !plan_.box_follows && !plan_.scene.target.packing_fraction;
    for (int tries = 0;; ++tries) {
      Packing packing = run(made_plan(scene_of_radii(plan_.scene, radii_)), options);
      stopped_ = packing.outcome == Outcome::cancelled;
      if (stopped_ || is_packed(packing.outcome) || !may_shrink || tries == most_shrinks) return packing;
      for (double& r : radii_) r *= std::cbrt(share_after_shrink);
    }
  }

  bool can_have_cells(const Packing& packing) const {
    return !stopped_ && packing.spheres.size() == volumes_.size();
  }

  /// Keeps the packing if its own cells are nearer to what is wanted than those of the best before.
  void take(Packing packing) {
    const std::optional<LocalPacking> local = local_packing(packing.spheres, packing.domain);
    own_ = local->cell_volume;
    const double distance = distance_of(own_, scale_in(packing));
    of_radii_ = by_rank(packing.spheres.r);
    scale_ = scale_in(packing);
    if (best_ && distance >= best_distance_) return;
    if (best_ && is_packed(best_->outcome) && !is_packed(packing.outcome)) return;
    best_distance_ = distance;
    best_ = std::move(packing);
  }

  double scale_in(const Packing& packing) const { return packing.volume / sum_of(volumes_); }

  /// Of volumes, where those that are stated are all `scale` times as large.
  double distance_of(const std::vector<double>& volumes, double scale) const {
    std::vector<double> sizes;
    for (const double volume : volumes) sizes.push_back(stated_.size_of(volume / scale));
    return compare_sizes(sizes, *stated_.sizes, 3).ks_statistic;
  }

  /// Of the spheres by their last cells. The sum of all volumes stays that of the box.
  void correct_radii() {
    std::vector<double> wanted, own;
    for (std::size_t k = 0; k < volumes_.size(); ++k) {
      wanted.push_back(scale_ * volumes_[k]);
      own.push_back(own_[of_radii_[k]]);
    }
    const Correction correction(wanted, own);
    const bool follows = plan_.box_follows;
    double before = 0, after = 0;
    for (std::size_t k = 0; k < radii_.size(); ++k) {
      before += std::pow(radii_[k], 3);
      radii_[k] *= correction.factor(wanted[k]);
      after += std::pow(radii_[k], 3);
    }
    std::ranges::sort(radii_);
    // So that all have as much room as before, or a box that follows from them the volume that is stated.
    const double room = std::cbrt(before / after / (follows ? scale_ : 1));
    for (double& r : radii_) r *= room;
  }

  /// So that a box whose size is free has the volume of all cells. Radii lose what centres may be rounded by.
  void scale_to_volumes(Packing& packing) const {
    auto& box = std::get<Box>(packing.domain);
    const double factor = std::cbrt(1 / scale_in(packing));
    const double rounding =
        16 * std::numeric_limits<double>::epsilon() * factor * bounds_of(packing.domain).diagonal();
    box.corner *= factor;
    box.size *= factor;
    for (auto& coordinates : packing.spheres.x)
      for (double& x : coordinates) x *= factor;
    for (double& r : packing.spheres.r) r = std::max(factor * r - rounding, 0.5 * factor * r);
    wrap(packing.spheres, packing.domain);
    packing.volume = volume_of(packing.domain);
    packing.container = nullptr;
    for (double& edge : std::get<PeriodicBox>(packing.scene.container).size) edge *= factor;
  }

  void find_weights(Packing& packing) {
    if (plan_.box_follows) scale_to_volumes(packing);
    Effect effect{cells_effect, 0, 0};
    options_.monitor.report({cells_effect, 0.9, fmt::format("{} cells", grouped(volumes_.size()))});
    CellWeights found;
    PackedCells cells;
    const std::vector<double> own = local_packing(packing.spheres, packing.domain)->cell_volume;
    const std::vector<std::uint32_t> order = by_rank(own);
    cells.scale = scale_in(packing);
    std::vector<double> wanted(own.size());
    for (std::size_t k = 0; k < order.size(); ++k) wanted[order[k]] = cells.scale * volumes_[k];
    try {
      const EffectTimer timer(effect);
      const Interruptible interruptible(options_.monitor);
      found = weights_for_volumes(packing.spheres, packing.domain, wanted);
    } catch (const Cancelled&) {
      stopped_ = true;
      return;
    }
    effect.calls += static_cast<std::uint64_t>(found.steps);
    for (std::size_t i = 0; i < own.size(); ++i)
      if (std::abs(found.volumes[i] / wanted[i] - 1) < same_volume) found.volumes[i] = wanted[i];
    cells.distance_by_radii = distance_of(own, cells.scale);
    cells.distance = distance_of(found.volumes, cells.scale);
    cells.error = found.error;
    cells.mean_sphericity = sum_of(found.sphericity) / static_cast<double>(own.size());
    cells.rounds = rounds_;
    cells.steps = found.steps;
    std::vector<double> by_radii = own, reached = found.volumes;
    std::ranges::sort(by_radii);
    std::ranges::sort(reached);
    // The k-th of N cells is wanted where the share is (k + 1/2) / N; between two of them it is straight.
    const auto below = [](const std::vector<double>& sorted, double share) {
      const double place = share * static_cast<double>(sorted.size()) - 0.5;
      const double last = static_cast<double>(sorted.size() - 1),
                   from = std::floor(std::clamp(place, 0.0, last));
      const auto k = static_cast<std::size_t>(from);
      const double part = std::clamp(place - from, 0.0, 1.0);
      return k + 1 < sorted.size() ? sorted[k] + part * (sorted[k + 1] - sorted[k]) : sorted[k];
    };
    for (const double share : {0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99})
      cells.quantiles.push_back({share, cells.scale * stated_.volume_of(stated_.sizes->quantile(share)),
                                 below(by_radii, share), below(reached, share)});
    if (cells.error < same_volume) {
      packing.reason +=
          fmt::format("; the cells have the volumes asked for, within {:.1g} of each", cells.error);
    } else {
      if (packing.outcome == Outcome::converged) packing.outcome = Outcome::hit_limit;
      packing.reason += fmt::format(
          "; the cells do not have the volumes asked for: after {} step{} of their weights the farthest is "
          "{:.2g} of its volume off; ask for a narrower distribution",
          cells.steps, cells.steps == 1 ? "" : "s", cells.error);
    }
    packing.weights = std::move(found.weights);
    packing.cells = std::move(cells);
    packing.effects.push_back(effect);
  }

  /// As it is stated, with what the run says in it.
  void state_scene(Packing& packing) const {
    SceneContainer container = std::move(packing.scene.container);
    const std::uint64_t seed = packing.scene.seed;
    packing.scene = plan_.scene;
    packing.scene.container = std::move(container);
    packing.scene.seed = seed;
    packing.caution = plan_.caution;
    packing.hints = plan_.hints;
    packing.expected_packing_fraction = plan_.expected_packing_fraction;
  }

  const Plan& plan_;
  const RunOptions& options_;
  const StatedCells stated_;
  const Stopwatch watch_;
  std::vector<double> volumes_;  // as they are stated, ascending
  std::vector<double> radii_;    // of the spheres of the next run, ascending
  int rounds_ = 0;
  bool stopped_ = false;
  // Of the last packing: the volumes of its own cells, its spheres by their radii, and what the volumes are
  // times those stated.
  std::vector<double> own_;
  std::vector<std::uint32_t> of_radii_;
  double scale_ = 1;
  std::optional<Packing> best_;
  double best_distance_ = 0;
};

}  // namespace

Packing run_cells(const Plan& plan, const RunOptions& options) { return CellRun(plan, options).found(); }

}  // namespace bernal
