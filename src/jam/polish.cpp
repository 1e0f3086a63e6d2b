#include "jam/polish.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/tolerance.hpp"
#include "core/every_dimension.hpp"
#include "jam/held.hpp"
#include "jam/jamming_energy.hpp"
#include "jam/trust_region.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

constexpr double fall_of_pressure = 0.1, rise_of_pressure = 1000;
/// Mean overlap ratio at the first level: at least the first, so that a network comes to bear the load; at
/// most the second.
constexpr double gentlest_start = 1e-4, hardest_start = 0.1;
/// Where spheres come loose: far from holding each other, with steps as long as overlaps are large.
constexpr double loose_start = 1e-2;
constexpr int most_steps_when_loose = 2000, most_climbs = 2;
constexpr std::size_t solved_closely = 3000;
constexpr double close_balance = 1e-5, loose_balance = 1e-3;
constexpr int most_steps_a_level = 500;
/// How many contacts beyond the isostatic number are let go at most.
constexpr std::ptrdiff_t most_let_go = 20;
/// Rattlers keep away from their cages, where these are wide enough, by some of this, a gap ratio.
constexpr double room = 1e-4;
/// How far spheres may move, in diameters, while their contacts are held; and in how many steps: of contacts
/// that do hold the spheres a few are enough, and with one too few there is no end of sliding.
constexpr double held_way = 0.01;
constexpr int most_steps_when_held = 20;
constexpr double seconds_between_reports = 0.25;
/// Up to this imbalance the end counts as equilibrium.
constexpr double balanced = 1e-2;

/// What is polished, and for whom.
struct PolishTask {
  double tolerance;
  double slenderness;             ///< longest edge over smallest radius
  int symmetries;                 ///< motions of all spheres together that the walls do not feel
  double start = gentlest_start;  ///< overlap ratio at the first level, at least
  int most_steps = most_steps_a_level;
  int most_climbs = 0;     ///< how often it may go back to a larger load
  double least_scale = 0;  ///< of the box: it gives up before it is smaller
  const Monitor& monitor;
  std::function<void(double done, double largest_overlap)> report;
  Checkpoints* checkpoints = nullptr;
};

class Polish {
 public:
  Polish(std::unique_ptr<JammingFunction> soft, PolishTask task)
      : soft_(std::move(soft)), task_(std::move(task)) {
    const auto n = static_cast<double>(soft_->size());
    balance_ = soft_->size() <= solved_closely ? close_balance : loose_balance;
    settled_ = std::min(1e-6, 0.1 / (n * n));
  }

  StageEnd run() {
    double overlap = 0;
    bool is_settled = false;  // at this overlap
    std::optional<Checkpoints::Part> part;
    if (task_.checkpoints)
      part.emplace(*task_.checkpoints, "polish", [&](Archive& a) {
        a(overlap, is_settled, *soft_, start_, imbalance_, overlap_, done_, unfinished_, climbs_);
      });
    if (!part || !part->resumed()) {
      soft_->set_level(task_.start, 0);
      overlap = start_ = std::clamp(soft_->largest_overlap(), task_.start, hardest_start);
    }
    for (;; is_settled = false) {
      if (!is_settled) {
        unfinished_ = false;
        if (!settle({.overlap = overlap, .smoothing = overlap, .balance = balance_, .is_resumable = true}))
          break;
        report();
      }
      if (overlap > settled_) {
        overlap =
            unfinished_ && may_climb() ? climb(overlap) : std::max(settled_, overlap * fall_of_pressure);
        continue;
      }
      is_settled = true;
      if (close(overlap) || cancelled_ || too_loose()) break;
      if (unfinished_ && may_climb()) {
        overlap = climb(overlap);
        continue;
      }
      // What is in equilibrium there has no more contacts at less, and the coordinates allow no better.
      if (soft_->largest_overlap() <= task_.tolerance || overlap * fall_of_pressure < resolution()) break;
      overlap *= fall_of_pressure;
    }
    return result();
  }

  const JammingFunction& soft() const { return *soft_; }
  /// How many spheres are no rattlers.
  std::size_t held() {
    count_contacts();
    return backbone_.spheres;
  }
  /// Their share of the volume, as they were counted last.
  double held_volume() const {
    double all = 0, held = 0;
    for (std::size_t i = 0; i < soft_->size(); ++i) {
      const double volume = ball_volume(soft_->dimension(), soft_->radius(i));
      all += volume;
      if (backbone_.has[i]) held += volume;
    }
    return held / all;
  }
  /// Under a load overlaps make it smaller than it will be: of spheres that two contacts hold by D times the
  /// overlap of those that 2 D hold.
  bool too_loose() const { return soft_->scale() < task_.least_scale / (1 + soft_->dimension() * overlap_); }

 private:
  struct Level {
    double overlap, smoothing;
    double balance;
    double radius = 0;  // of the trust region: a ratio; 0 for ten overlaps
    double forcing = 0.03;
    int most_steps = 0;  // 0 for the task's
    bool is_resumable = false;
  };

  /// What slides on without an end at a small load has a longer way to go than its steps allow there: it goes
  /// the way under a larger one.
  bool may_climb() const { return climbs_ < task_.most_climbs; }
  double climb(double overlap) {
    ++climbs_;
    return std::min(start_, overlap * rise_of_pressure);
  }

  /// Takes the smoothing away and closes the contacts. It has no state of its own: cut short, it leaves all
  /// as it was, and so does a checkpoint. Returns whether they are closed.
  bool close(double overlap) {
    const Saved before = save();
    const double overlap_before = overlap_, done_before = done_;
    const bool closed = sharpen(overlap) && (is_closed() || close_contacts(overlap));
    if (cancelled_) {
      restore(before);
      overlap_ = overlap_before;
      done_ = done_before;
      milestones_.clear();
      if (task_.checkpoints) task_.checkpoints->stop();
    }
    report();
    return closed;
  }

  /// Takes the smoothing away. Returns false if cancelled or too loose.
  bool sharpen(double overlap) {
    for (const double smoothing : {0.1, 0.01, 0.0})
      if (!settle({overlap, smoothing * overlap, 0.1 * balance_})) return false;
    return true;
  }

  /// Where the contacts suffice: holds them and takes their overlaps to half the tolerance; those beyond the
  /// isostatic number are let go, each time the one that would be the first to pull. Returns whether that
  /// gave a packing under pressure everywhere; else all is as it was, at `overlap`.
  bool close_contacts(double overlap) {
    count_contacts();
    if (excess() < 0 || excess() > most_let_go) return false;
    std::ptrdiff_t spare = excess();
    const Saved before = save();
    const auto give_up = [&] {
      restore(before);
      return false;
    };
    const double fall = 0.5 * task_.tolerance / soft_->largest_overlap();
    soft_->hold(backbone_.has);
    for (;;) {
      std::unique_ptr<JammingFunction> held = soft_->copy();
      if (!settle({overlap * fall, 0, 0.1 * balance_, held_way, 1e-4, most_steps_when_held}) ||
          imbalance_ >= balanced)
        return give_up();
      const auto first = first_to_pull(*held, *soft_);
      if (first < 0) break;
      soft_ = std::move(held);
      if (spare-- == 0) break;
      soft_->let_go(static_cast<std::size_t>(first));
    }
    soft_->release();
    if (!make_room_for_rattlers()) return give_up();
    soft_->set_level(overlap * fall, 0);
    return is_closed() || give_up();
  }

  /// Whether nothing overlaps by more than is asked for, forces balance, and as many contacts bear them as it
  /// takes to hold the spheres.
  bool is_closed() {
    if (soft_->largest_overlap() > task_.tolerance || !(imbalance_ < balanced)) return false;
    count_contacts();
    return backbone_.spheres > 0 && excess() >= 0;
  }

  /// Moves rattlers that the others have come to overlap back into their cages. Returns false if cancelled.
  bool make_room_for_rattlers() {
    const double imbalance = imbalance_;
    soft_->fix(backbone_.has);
    for (double gap = room; gap > 1e-3 * task_.tolerance; gap *= 1e-2)
      if (!settle({gap, gap, loose_balance}) || soft_->largest_overlap() <= task_.tolerance) break;
    soft_->release();
    imbalance_ = imbalance;
    return !cancelled_;
  }

  /// Of the same contacts at two levels of pressure: which one's force, linear in between, is the first to
  /// vanish; -1 if none does.
  static std::ptrdiff_t first_to_pull(const JammingFunction& high, const JammingFunction& low) {
    std::ptrdiff_t first = -1;
    double least = 0;
    for (std::size_t c = 0; c < low.contact_count(); ++c) {
      const double tension = low.tension_of(c).tension;
      if (tension > 0) continue;
      const double remaining = tension / high.tension_of(c).tension;  // 0 or less: the smaller, the earlier
      if (first < 0 || remaining < least) {
        first = static_cast<std::ptrdiff_t>(c);
        least = remaining;
      }
    }
    return first;
  }

  /// Contacts beyond the isostatic number.
  std::ptrdiff_t excess() const {
    return static_cast<std::ptrdiff_t>(backbone_.holds) -
           isostatic_number(soft_->dimension(), backbone_.spheres, task_.symmetries);
  }

  /// Minimises at one level of pressure. Returns false if cancelled or too loose.
  [[nodiscard]] bool settle(const Level& level) {
    const double overlap = overlap_ = level.overlap;
    std::optional<TrustRegion> made;
    double radius = 0;
    int step = 0;
    Checkpoints* const checkpoints = level.is_resumable ? task_.checkpoints : nullptr;
    std::optional<Checkpoints::Part> part;
    if (checkpoints)
      part.emplace(*checkpoints, "level", [&](Archive& a) {
        if (made) radius = made->radius();
        a(step, radius);
      });
    if (!part || !part->resumed()) {
      soft_->set_level(overlap, level.smoothing);
      radius = soft_->length_of(level.radius > 0 ? level.radius : 10 * overlap);
    }
    const double noise = resolution() / overlap;
    TrustRegion& region = made.emplace(*soft_, radius, level.forcing, task_.monitor);
    const int most_steps = level.most_steps > 0 ? level.most_steps : task_.most_steps;
    for (;; ++step) {
      if (step == most_steps) {
        unfinished_ = unfinished_ || imbalance_ > loose_balance;
        break;
      }
      imbalance_ = region.gradient_length() / std::sqrt(2 * soft_->elastic_energy());
      if (!(imbalance_ >= std::max(level.balance, 4 * noise))) break;  // or there is neither force nor load
      if (checkpoints ? checkpoints->stop() : task_.monitor.stop()) {
        cancelled_ = true;
        return false;
      }
      tell();
      const bool moved = region.step(std::max(1e-6, noise) * soft_->elastic_energy());
      if (region.stopped()) {
        if (checkpoints) checkpoints->stop();  // which writes one, of what was before the step
        cancelled_ = true;
        return false;
      }
      if (!moved && region.radius() < soft_->length_of(resolution())) break;  // what is left is rounding
    }
    if (too_loose()) return false;  // not before: on its way the box may be smaller than it will be
    done_ = std::clamp(std::log(overlap / start_) / std::log(0.1 * task_.tolerance / start_), done_, 0.99);
    milestones_.emplace_back(done_, soft_->largest_overlap());
    return true;
  }

  /// Of levels, once nothing can take them back.
  void report() {
    for (const auto& [done, overlap] : milestones_) task_.report(done, overlap);
    milestones_.clear();
  }

  /// Within a level, now and then.
  void tell() {
    if (since_told_.seconds() < seconds_between_reports) return;
    since_told_ = {};
    task_.monitor.report({"polish", done_,
                          fmt::format("{} contacts, forces balanced to {:.0e}, largest overlap {:.1e}",
                                      soft_->contact_count(), imbalance_, soft_->largest_overlap())});
  }

  /// An overlap ratio that is lost in the rounding of coordinates.
  double resolution() const { return 2 * tolerance::roundoff * task_.slenderness; }

  StageEnd result() {
    if (cancelled_) return StageEnd::cancelled;
    return is_closed() && !too_loose() ? StageEnd::converged : StageEnd::hit_limit;
  }

  /// Those that bear force.
  void count_contacts() {
    std::vector<Hold> holds;
    for (std::size_t k = 0; k < soft_->contact_count(); ++k)
      if (const auto c = soft_->tension_of(k); c.tension > 0)
        holds.push_back({c.first, c.second == JammingFunction::wall ? Hold::wall : c.second});
    backbone_ = backbone_of(soft_->dimension(), soft_->size(), holds);
  }

  /// What is taken back where contacts do not close.
  struct Saved {
    std::unique_ptr<JammingFunction> soft;
    double imbalance;
    bool unfinished;
  };
  Saved save() const { return {soft_->copy(), imbalance_, unfinished_}; }
  void restore(const Saved& saved) {
    soft_ = saved.soft->copy();
    imbalance_ = saved.imbalance;
    unfinished_ = saved.unfinished;
  }

  std::unique_ptr<JammingFunction> soft_;
  const PolishTask task_;
  double balance_, settled_;
  double start_ = gentlest_start;
  double imbalance_ = 0;
  double overlap_ = 0;  // of the present level
  double done_ = 0;
  Stopwatch since_told_;
  std::vector<std::pair<double, double>> milestones_;  // that are still to be told
  bool unfinished_ = false;                            // a level ended far from equilibrium
  int climbs_ = 0;
  bool cancelled_ = false;
  Backbone backbone_;  // by place in soft_
};

}  // namespace

template <int D>
StageEnd polish(Spheres<D>& spheres, Vector<D>& edges, double tolerance, const SpheresInBox& in_box,
                Reporter& report) {
  if (spheres.empty()) return StageEnd::converged;
  const auto walls = static_cast<int>(std::ranges::count(in_box.task.walls, true));
  std::shared_ptr<const Enclosure<D>> enclosure;
  if (walls > 0) enclosure = std::make_shared<Enclosure<D>>(edges, in_box.task.walls);
  auto soft =
      std::make_unique<JammingEnergy<D>>(spheres, edges_around_walls(edges, in_box.task.walls), enclosure);
  Polish act(
      std::move(soft),
      {.tolerance = tolerance,
       .slenderness = edges.maxCoeff() / std::ranges::min(spheres.r),
       .symmetries = D - walls,
       .monitor = report.monitor,
       .report = [&](double done, double overlap) { report.milestone("polish", in_box, overlap, done); },
       .checkpoints = report.checkpoints});
  const StageEnd end = act.run();
  const auto& polished = dynamic_cast<const JammingEnergy<D>&>(act.soft());
  polished.write(spheres);
  edges = walls > 0 ? Vector<D>(edges * polished.scale()) : polished.edges();
  return end;
}

Jammed polish_in_container(const Spheres<3>& spheres, const Container& container, int symmetries,
                           double tolerance, const Monitor& monitor,
                           const std::function<void(double, double)>& report, Checkpoints* checkpoints) {
  return with_dimension(container.dimension(), std::integer_sequence<int, 2, 3>{}, [&](auto axes) {
    constexpr int D = decltype(axes)::value;
    const Vector<D> edges = edges_around(container, std::ranges::max(spheres.r)).template head<D>();
    Spheres<D> polished = along_axes<D>(spheres);
    Polish act(std::make_unique<JammingEnergy<D>>(polished, edges, std::make_shared<Enclosure<D>>(container)),
               {.tolerance = tolerance,
                .slenderness = container.bounds().size().maxCoeff() / std::ranges::min(spheres.r),
                .symmetries = symmetries,
                .start = loose_start,
                .most_steps = most_steps_when_loose,
                .most_climbs = most_climbs,
                .least_scale = 1 / Jammed::most_growth,
                .monitor = monitor,
                .report = report,
                .checkpoints = checkpoints});
    Jammed jammed{act.run(), spheres, 1, act.too_loose(), act.held(), act.held_volume()};
    dynamic_cast<const JammingEnergy<D>&>(act.soft()).write_to_scale(polished);
    std::copy_n(polished.x.begin(), D, jammed.spheres.x.begin());
    jammed.growth = (1 - act.soft().largest_overlap()) / act.soft().scale();
    return jammed;
  });
}

#define BERNAL_INSTANTIATE(D) \
  template StageEnd polish<D>(Spheres<D>&, Vector<D>&, double, const SpheresInBox&, Reporter&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
