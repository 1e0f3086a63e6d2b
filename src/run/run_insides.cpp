#include "run/run_insides.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "bernal/core/text.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "core/made.hpp"
#include "plan/plan_insides.hpp"
#include "run/begin_packing.hpp"
#include "work/effect_log.hpp"

namespace bernal {
namespace {

/// Of a uniform rotation: Shoemake, Uniform random rotations, Graphics Gems III, 1992.
std::array<double, 4> uniform_rotation(Random& random) {
  const double share = random.uniform(), first = 2 * std::numbers::pi * random.uniform(),
               second = 2 * std::numbers::pi * random.uniform();
  std::array<double, 4> q = {std::sqrt(1 - share) * std::sin(first), std::sqrt(1 - share) * std::cos(first),
                             std::sqrt(share) * std::sin(second), std::sqrt(share) * std::cos(second)};
  double squared = 0;
  for (const double c : q) squared += c * c;
  for (double& c : q) c /= std::sqrt(squared);
  return q;
}

/// Keys of the streams: spheres have numbers below 2^31, packings are keyed above.
std::uint64_t seed_of_packing(std::uint64_t seed, std::size_t inside, std::uint64_t number) {
  Random random(seed, stream(Stream::inside, (static_cast<std::uint64_t>(inside + 1) << 40) | number));
  return random() >> 1;
}

/// The packings of one `PlannedInside`.
class Filling {
 public:
  Filling(const Plan& plan, std::size_t k, const RunOptions& options, const Packing& packing,
          const SphereLayers& layers)
      : plan_(plan), inside_(plan.insides[k]), k_(k), options_(options), packing_(packing) {
    filled_.of_class = inside_.of_class;
    filled_.layer = inside_.layer;
    for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
      if (!packing.classes.empty() && packing.classes[i] != inside_.of_class) continue;
      filled_.spheres.push_back(static_cast<std::uint32_t>(i));
      const std::span<const double> of = layers.empty() ? std::span<const double>() : layers.of(i);
      balls_.push_back(of.empty() ? packing.spheres.r[i] : of.front());
    }
    const std::size_t n = filled_.spheres.size();
    const auto most = static_cast<std::size_t>(inside_.templates.value_or(0));
    filled_.templates.resize(most > 0 ? std::min(n, most) : n);
    if (most > 0) require_one_radius();
  }

  /// Packs them, and tells from time to time in this thread how many there are, and of one how far it is.
  void pack(const std::function<void(std::size_t done, double part)>& tell) {
    const std::size_t packings = filled_.templates.size();
    const std::size_t threads =
        std::min<std::size_t>(packings, static_cast<std::size_t>(std::max(1, packing_.threads)));
    std::atomic<std::size_t> next = 0, ended = 0;
    std::exception_ptr thrown;
    std::mutex turn;
    tell(0, 0);
    const auto work = [&](const std::function<void(const Progress&)>& of_one) {
      try {
        for (std::size_t t; (t = next++) < packings && !options_.monitor.stop(); ++ended)
          pack_one(t, threads > 1 ? 1 : packing_.threads, of_one);
      } catch (...) {
        const std::lock_guard lock(turn);
        if (!thrown) thrown = std::current_exception();
        next = packings;
      }
    };
    std::vector<std::thread> others;
    for (std::size_t k = 1; k < threads; ++k) others.emplace_back([&] { work({}); });
    work([&](const Progress& of_one) { tell(ended, packings == 1 ? std::max(0.0, of_one.fraction) : 0); });
    for (std::thread& other : others) other.join();
    if (thrown) std::rethrow_exception(thrown);
    choose();
  }

  PackingsInside take() { return std::move(filled_); }
  std::size_t packings() const { return filled_.templates.size(); }

 private:
  /// Spheres that a start has may be of any radius.
  void require_one_radius() const {
    const auto [least, largest] = std::ranges::minmax_element(balls_);
    constexpr double rounding = 1e-9;
    if (balls_.empty() || *largest <= (1 + rounding) * *least) return;
    throw Error(ErrorCode::bad_scene,
                fmt::format("the balls inside of {} have radii from {:.6g} to {:.6g} {}, and each needs a "
                            "packing of its own: leave \"templates\" out",
                            inside_.name, *least, *largest, name_of(plan_.scene.unit)),
                plan_.scene.inside[k_].locations.of("templates"));
  }

  /// One that fits every ball that it is to lie in.
  double ball_of(std::size_t t) const {
    return inside_.templates ? *std::ranges::min_element(balls_) : balls_[t];
  }

  void pack_one(std::size_t t, int threads, const std::function<void(const Progress&)>& tell) {
    const double ball = ball_of(t);
    std::optional<Plan> own;
    if (ball != inside_.ball) own = plan_in_ball(plan_, inside_, ball);
    const std::uint64_t number = inside_.templates ? t : filled_.spheres[t];
    const RunOptions options{.seed = seed_of_packing(packing_.seed, k_, number),
                             .threads = threads,
                             .monitor = {tell, options_.monitor.cancelled},
                             .checkpoints = {},
                             .engine_folder = {}};
    auto packed = std::make_shared<Packing>(run(own ? *own : inside_.plan, options));
    packed->threads = packing_.threads;
    if (packed->outcome != Outcome::cancelled) filled_.templates[t] = std::move(packed);
  }

  /// Which packing every sphere holds, of those that are there, and how it is turned.
  void choose() {
    std::vector<std::uint32_t> spheres;
    std::vector<std::uint32_t> number_of(filled_.templates.size());
    std::uint32_t there = 0;
    for (std::size_t t = 0; t < number_of.size(); ++t) number_of[t] = filled_.templates[t] ? there++ : there;
    for (std::size_t i = 0; i < filled_.spheres.size(); ++i) {
      Random random(packing_.seed, stream(Stream::inside, filled_.spheres[i]));
      const double share = random.uniform();
      const auto drawn = static_cast<std::size_t>(share * static_cast<double>(number_of.size()));
      const std::size_t t = inside_.templates ? std::min(drawn, number_of.size() - 1) : i;
      if (!filled_.templates[t]) continue;
      spheres.push_back(filled_.spheres[i]);
      filled_.which.push_back(number_of[t]);
      filled_.rotations.push_back(inside_.templates ? uniform_rotation(random)
                                                    : std::array<double, 4>{1, 0, 0, 0});
    }
    filled_.spheres = std::move(spheres);
    std::erase(filled_.templates, nullptr);
  }

  const Plan& plan_;
  const PlannedInside& inside_;
  const std::size_t k_;
  const RunOptions& options_;
  const Packing& packing_;
  const Made made_{inside_effect};
  std::vector<double> balls_;  // in which they are to lie, one a filled sphere
  PackingsInside filled_;
};

/// "inside pebble: 10 packings of 19,120 to 19,140 spheres", or what is wrong with the worst of them.
void take_outcome(Packing& whole, const PackingsInside& filled, std::size_t packings,
                  const std::string& name) {
  const auto& made = filled.templates;
  const auto count = [](const auto& packing) { return packing->spheres.size(); };
  whole.reason += fmt::format("; inside {}: ", name);
  if (made.size() < packings) {
    whole.outcome = std::max(whole.outcome, Outcome::cancelled);
    whole.reason += fmt::format("stopped by the user, {} of {} packings are there", made.size(), packings);
    return;
  }
  if (made.empty()) {
    whole.reason += "there are no spheres of this class";
    return;
  }
  const auto worst = std::ranges::max_element(made, {}, [](const auto& packing) { return packing->outcome; });
  whole.outcome = std::max(whole.outcome, (*worst)->outcome);
  if (falls_short((*worst)->outcome)) {
    whole.reason += fmt::format("packing {} of {} is {}: {}", worst - made.begin() + 1, packings,
                                name_of((*worst)->outcome), (*worst)->reason);
    return;
  }
  const auto [least, most] = std::ranges::minmax(made | std::views::transform(count));
  whole.reason += fmt::format("{} of {} {}", packings == 1 ? "one packing" : grouped(packings) + " packings",
                              least == most ? grouped(most) : grouped(least) + " to " + grouped(most),
                              most == 1 ? "sphere" : "spheres");
}

/// What the packings inside brought, with what the spheres around them brought.
void add_effects(std::vector<Effect>& effects, const PackingsInside& inside) {
  for (const auto& packing : inside.templates)
    for (const Effect& effect : packing->effects) {
      const auto same = std::ranges::find(effects, effect.name, &Effect::name);
      if (same == effects.end())
        effects.push_back(effect);
      else
        *same += effect;
    }
}

/// Of the time of a run, what is gone before the k-th of its insides; all of it for their number.
double share_before(const Plan& plan, std::size_t k) {
  double inside = 0, before = 0;
  for (std::size_t j = 0; j < plan.insides.size(); ++j) {
    const double seconds = plan.insides[j].packings() * std::max(1e-9, plan.insides[j].plan.expected_seconds);
    inside += seconds;
    if (j < k) before += seconds;
  }
  const double spheres = std::max(1e-9, plan.expected_seconds - inside);
  return (spheres + before) / (spheres + inside);
}

}  // namespace

Packing run_with_insides(const Plan& plan, const RunOptions& asked) {
  std::atomic<bool> stopped = false;  // what said stop once is not asked again, by any packing
  RunOptions options = asked;
  if (asked.monitor.cancelled) {
    options.monitor.cancelled = [&] {
      if (!stopped && asked.monitor.cancelled()) stopped = true;
      return stopped.load();
    };
  }
  RunOptions of_spheres = options;
  const double share = share_before(plan, 0);
  of_spheres.monitor.on_progress = [&](Progress progress) {
    if (progress.fraction > 0) progress.fraction *= share;
    options.monitor.report(progress);
  };
  Packing packing = run_spheres(plan, of_spheres);
  const Stopwatch whole;
  Effect inside_them{inside_effect, 0, 0};
  const SphereLayers layers = layers_of(packing);
  for (std::size_t k = 0; k < plan.insides.size(); ++k) {
    const Stopwatch watch;
    const std::string activity = "inside " + plan.insides[k].name;
    Filling filling(plan, k, options, packing, layers);
    const std::size_t packings = filling.packings();
    const double from = share_before(plan, k), to = share_before(plan, k + 1);
    filling.pack([&](std::size_t done, double part) {
      const std::string detail = fmt::format("{} of {} packings", grouped(done), grouped(packings));
      const double share_of_packings = (static_cast<double>(done) + part) / static_cast<double>(packings);
      options.monitor.report({activity, from + (to - from) * share_of_packings, detail});
    });
    packing.inside.push_back(filling.take());
    take_outcome(packing, packing.inside.back(), packings, plan.insides[k].name);
    add_effects(packing.effects, packing.inside.back());
    inside_them += Effect{"", packings, watch.seconds()};
  }
  if (inside_them.calls > 0) packing.effects.push_back(inside_them);
  packing.seconds += whole.seconds();
  return packing;
}

}  // namespace bernal
