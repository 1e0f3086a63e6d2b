#include "run/run_largest.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/text.hpp"
#include "jam/few_spheres.hpp"
#include "plan/few_large.hpp"
#include "plan/made_plan.hpp"
#include "plan/room_for_gaps.hpp"
#include "run/begin_packing.hpp"
#include "run/run_insides.hpp"
#include "run/run_stages.hpp"
#include "work/supply.hpp"

namespace bernal {
namespace {

/// How much larger the spheres of the next run are, until one fails; and to what the largest that the stages
/// place are known: well below the gaps of up to 1e-4 that relaxation leaves.
constexpr double step = 1.05, known_to = 2e-5;
/// How much smaller few spheres are than the tightest arrangement of them allows: play for roundings.
constexpr double play = 1e-10;
/// Steps down to sizes that can be placed, at most.
constexpr int most_steps_down = 60;
/// Seeds from which a size is tried before it counts as too large: few spheres take no time, and how they
/// begin decides where they end, but of very few there are hardly any ways to end.
int tries_for(std::int64_t count) {
  return static_cast<int>(std::clamp<std::int64_t>(std::min(4 * count, 1600 / count), 4, 32));
}

class Search {
 public:
  Search(const Plan& plan, const RunOptions& options)
      : plan_(plan),
        options_(options),
        many_(tries_for(*plan.scene.target.count)),
        few_(std::clamp(many_ / 4, 2, 8)) {}

  Packing found() {
    if (options_.checkpoints.resume && options_.checkpoints.tell)
      options_.checkpoints.tell("the search for the largest spheres has no checkpoints; it starts anew");
    double scale = plan_.scene.scale;
    if (few_fit()) return concluded();
    minima_of_few_ = 0;
    for (int down = 0; !fits(scale, few_) && !stopped_; scale /= step) {
      too_large_ = scale;
      if (++down > most_steps_down) break;
    }
    // As many seeds as it takes only where that decides: just above what few of them place.
    while (fitting_ && !stopped_) {
      narrow_down();
      if (stopped_ || !fits(*fitting_ * (1 + known_to), many_)) break;
      too_large_.reset();
    }
    if (!best_) return last_ ? std::move(*last_) : run_spheres(build(scene_at(scale)), sub_options(0));
    return concluded();
  }

 private:
  Packing concluded() {
    Packing packing = std::move(*best_);
    packing.outcome = stopped_ ? Outcome::cancelled : Outcome::converged;
    packing.reason = in_words(packing);
    packing.caution = plan_.caution;  // those of the last of its runs are of a size that nobody asked for
    packing.hints = plan_.hints;
    packing.effects.push_back({"search", runs_, watch_.seconds()});
    packing.seconds = watch_.seconds();
    return packing;
  }

  /// Whether they are as large as the tightest arrangement that is found of few spheres allows, but for a
  /// little play. The scene of the result places as many of that size, where they may lie otherwise. Not
  /// where they are not few, where the stages do not search that way, and where sizes have no end or gaps
  /// around them that do not grow with them.
  bool few_fit() {
    const Scene& scene = plan_.scene;
    const auto count = static_cast<std::size_t>(*scene.target.count);
    if (!is_searched_once(plan_) || !scene.draw) return false;
    const Frame frame = frame_of(plan_.domain);
    const std::shared_ptr<const Container> container =
        plan_.container ? plan_.container : make_local_container(plan_.domain, frame, scene.walls);
    if (!are_few(count, *container)) return false;
    const std::uint64_t seed = *sub_options(0).seed;
    Supply supply({*plan_.radii, scene.dimension(), seed, *scene.draw}, volume_of(plan_.domain),
                  scene.target);
    supply.divide_by(frame.scale);
    FewPacked packed =
        pack_few(supply.radii(), *container, Places(*container),
                 {.enough = std::numeric_limits<double>::infinity(),
                  .seed = seed,
                  .monitor = options_.monitor,
                  .tell = [&](double done, double size) { tell(std::max(size, 1e-3) * scene.scale, done); }});
    minima_of_few_ = packed.minima;
    const double size = (1 - play) * packed.size - gap_of_few(*container) / supply.smallest();
    const bool all_stand = size > 0 && fits(size * scene.scale, 1, std::move(packed.centers));
    stopped_ = packed.cancelled;
    return all_stand;
  }

  /// Steps up until few seeds place no spheres that large, each twice the one before but the largest, and
  /// halves what is between.
  void narrow_down() {
    for (double by = best_is_first_ ? step : 1 + 2 * known_to; !too_large_ && !stopped_;
         by = std::min(by * by, step)) {
      const double scale = *fitting_ * by;
      if (!fits(scale, few_)) too_large_ = scale;
    }
    best_is_first_ = false;
    while (!stopped_ && *too_large_ > (1 + known_to) * *fitting_)
      if (const double scale = std::sqrt(*fitting_ * *too_large_); !fits(scale, few_)) too_large_ = scale;
  }

  /// The scene of spheres of a size: of one size, that size; else the scale.
  Scene scene_at(double scale) const {
    Scene scene = plan_.scene;
    scene.largest = false;
    scene.seed = *sub_options(winner_).seed;  // by which it is built
    scene.scale = 1;
    if (auto* one = std::get_if<Constant>(&scene.sizes))
      one->value *= scale;
    else
      scene.scale = scale;
    return scene;
  }

  RunOptions sub_options(int n) const {
    const std::uint64_t first = options_.seed.value_or(plan_.scene.seed);
    return {.seed = seed_of_run(first, static_cast<std::uint64_t>(n)),
            .threads = options_.threads,
            .monitor = {{}, options_.monitor.cancelled},
            .checkpoints = {},
            .engine_folder = options_.engine_folder};
  }

  /// Whether one of so many seeds places all spheres, or those that are few have these places; keeps its
  /// packing.
  bool fits(double scale, int tries, std::vector<Vector<3>> few_places = {}) {
    if (few_places.empty()) tell(scale, tries == many_ ? 0.7 : share_halved());
    std::optional<Plan> plan = made_plan_where_all_fit(scene_at(scale));
    if (!plan) return false;
    for (int n = 0; n < tries && !stopped_; ++n) {
      // First the one that placed the largest so far: it is likely to place larger ones.
      const int seed = n == 0 ? winner_ : n <= winner_ ? n - 1 : n;
      RunOptions options = sub_options(seed);
      plan->scene.seed = *options.seed;
      if (n > 0 && !all_may_fit(*plan)) continue;
      if (!few_places.empty()) options.monitor = {};  // they need no time any more
      last_ = run_spheres(*plan, options, few_places);
      ++runs_;
      stopped_ = last_->outcome == Outcome::cancelled;
      if (!is_packed(last_->outcome)) continue;
      best_ = std::move(last_);
      last_.reset();
      fitting_ = scale;
      winner_ = seed;
      return true;
    }
    return false;
  }

  /// "radius 0.3332 mm", or "scale 1.21".
  std::string size_in_words(double scale) const {
    const Scene& scene = plan_.scene;
    const auto* one = std::get_if<Constant>(&scene.sizes);
    return one ? fmt::format("{} {:.6g} {}", scene.sizes_are_diameters ? "diameter" : "radius",
                             one->value * scale, name_of(scene.unit))
               : fmt::format("scale {:.6g}", scale);
  }

  std::string in_words(const Packing& packing) const {
    const std::size_t n = packing.spheres.size();
    std::string text = fmt::format(
        "{} of {}, {} {} placed", n == 1 ? "the sphere" : grouped(n) + " spheres", size_in_words(*fitting_),
        n == 1 ? "as large as it fits," : "the largest found,", n == 1 ? "is" : "are");
    if (stopped_) return "stopped by the user: " + text + ", and larger ones may fit";
    if (minima_of_few_ > 0 && n == 1) return text;
    if (minima_of_few_ > 0)
      return text +
             fmt::format("; of {} arrangements none had room for larger ones", grouped(minima_of_few_));
    return text + fmt::format("; at {} none of {} seeds placed all",
                              size_in_words(*fitting_ * (1 + known_to)), many_);
  }

  /// Of the halvings that there are in all, those that are done.
  double share_halved() const {
    if (!fitting_ || !too_large_) return 0;
    return 0.6 * std::clamp(1 - std::log(std::log(*too_large_ / *fitting_) / known_to) /
                                    std::log(std::log(step) / known_to),
                            0.0, 1.0);
  }

  void tell(double scale, double done) const {
    options_.monitor.report(
        {"largest", done,
         in_dimension(plan_.scene.dimension(),
                      *plan_.scene.target.count == 1
                          ? "1 sphere of " + size_in_words(scale)
                          : fmt::format("{} spheres of {}",
                                        grouped(static_cast<std::uint64_t>(*plan_.scene.target.count)),
                                        size_in_words(scale)))});
  }

  const Plan& plan_;
  const RunOptions& options_;
  const int many_, few_;  // seeds
  const Stopwatch watch_;
  bool stopped_ = false, best_is_first_ = true;
  std::uint64_t runs_ = 0, minima_of_few_ = 0;
  int winner_ = 0;
  std::optional<double> fitting_, too_large_;  // scales
  std::optional<Packing> best_, last_;
};

}  // namespace

Packing run_largest(const Plan& plan, const RunOptions& options) {
  Packing packing = Search(plan, options).found();
  packing.reason = in_dimension(packing.scene.dimension(), packing.reason);
  return packing;
}

}  // namespace bernal
