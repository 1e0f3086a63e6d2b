// Every effect off and on: what it buys in packing fraction, and what it costs in time.
#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/hard/grow.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/soft/relax.hpp"
#include "cost/bench_tables.hpp"
#include "cost/effects_picture.hpp"
#include "cost/rounds.hpp"

namespace bernal::cost {
namespace {

constexpr int seeds_of_an_effect = 3;
constexpr std::int64_t usual_count = 1500;
constexpr std::int64_t least_wide_count = 300;  // for growth the box has to be some large spheres wide

/// Two scenes that differ in the effect and in nothing else.
struct EffectPair {
  std::string_view name;
  std::string_view scenes;  ///< what stands on both sides: "relaxation, alpha = 2, periodic box"
  std::string_view on, off;
  Scene with, without;
  /// What else to say of a trial: what the effect is for where that is not the packing fraction.
  std::function<std::string(const Trial& with, const Trial& without)> also = {};
};

Scene staged(Scene scene, std::vector<Stage> stages) {
  scene.stages = std::move(stages);
  return scene;
}

Scene filled(Scene scene, std::vector<Stage> stages) {
  scene.target = {.fill = true};
  return staged(std::move(scene), std::move(stages));
}

/// The protocol of settling with that tilt and those rounds of shaking after every refilling.
std::vector<Stage> settling(double tilt, int shakes) {
  const Compress compress{.tilt = tilt};
  return {Insert{}, compress, Refill{.shake = {.rounds = shakes, .compress = compress}}};
}

std::string contacts_text(const Trial& with, const Trial& without) {
  const auto closed = [](const Trial& t) {
    return t.held_from ? fmt::format("{:.0e}", *t.held_from) : std::string("more than 1e-2");
  };
  return fmt::format("contacts are closed to a gap ratio of {} instead of {}", closed(with), closed(without));
}

/// A cube becomes a column of that many times its width, of the same volume.
Scene as_column(Scene scene, double times) {
  auto& box = std::get<PeriodicBox>(scene.container);
  box.size = {1, 1, times};
  box.scalable = true;
  return scene;
}

std::vector<EffectPair> all_effects(const BenchOptions& options) {
  const SizeClass equal = equal_sizes(), wide = one_to_five();
  const std::int64_t count = equal.count_for(options.spheres > 0 ? options.spheres : usual_count);
  const double predicted = predicted_for(equal);
  const Scene periodic = room_for(equal, count, Sides::none, 0);
  const Scene lids = room_for(equal, count, Sides::lids, share_between_lids * predicted);
  const Scene box = room_for(equal, count, Sides::all, share_between_lids * predicted);
  const Scene wide_periodic = room_for(wide, std::max(count, least_wide_count), Sides::none, 0);
  const auto overfull = [&](Scene scene, std::vector<Stage> stages) {  // it jams before that
    scene.target.packing_fraction = share_that_jams * predicted;
    return staged(std::move(scene), std::move(stages));
  };

  return {{"tilt", "compression and refilling between floor and lid", "tilt = 2", "tilt = 0",
           filled(lids, settling(2, 0)), filled(lids, settling(0, 0))},
          {"shaking", "compression and refilling between floor and lid", "shakes = 1", "shakes = 0",
           filled(lids, settling(2, 1)), filled(lids, settling(2, 0))},
          {"refilling", "compression between floor and lid", "insert, compress, refill", "insert, compress",
           filled(lids, settling(2, 0)), filled(lids, {Insert{}, Compress{}})},
          {"stirring", "relaxation between floor and lid", "patience = 12", "patience = 0",
           filled(lids, {Relax{.patience = 12}}), filled(lids, {Relax{.patience = 0}})},
          {"many sweeps", "relaxation in a periodic box", "alpha = 17", "alpha = 2",
           staged(periodic, {Relax{.alpha = 17}}), staged(periodic, {Relax{.alpha = 2}})},
          {"over-relaxed sweeps on lists", "relaxation in a periodic box, alpha = 2", "method = fast",
           "method = reference", staged(periodic, {Relax{.alpha = 2}}),
           staged(periodic, {Relax{.alpha = 2, .method = RelaxMethod::reference}})},
          {"polish", "relaxation in a periodic box, alpha = 2", "polish = 1e-8", "polish = 0",
           staged(periodic, {Relax{.alpha = 2, .polish = 1e-8}}), staged(periodic, {Relax{.alpha = 2}}),
           contacts_text},
          {"slow growth", "growth in a periodic box", "rate = 0.02", "rate = 0.2",
           staged(periodic, {Grow{.rate = 0.02}}), staged(periodic, {Grow{.rate = 0.2}})},
          {"growth to the end", "growth in a periodic box, rate = 0.05", "pressure = 1e6", "pressure = 1e3",
           staged(periodic, {Grow{.rate = 0.05, .pressure = 1e6}}),
           staged(periodic, {Grow{.rate = 0.05, .pressure = 1e3}}), contacts_text},
          {"unequal masses", "growth of diameters 1 : 5 in a periodic box, rate = 0.03", "masses = volume",
           "masses = equal", staged(wide_periodic, {Grow{.rate = 0.03, .masses = Masses::by_volume}}),
           staged(wide_periodic, {Grow{.rate = 0.03}})},
          {"a floor and a lid", "growth, rate = 0.1, until jammed", "box between floor and lid",
           "periodic box", filled(lids, {Grow{.rate = 0.1}}), staged(periodic, {Grow{.rate = 0.1}})},
          {"side walls", "growth, rate = 0.1, until jammed", "box", "the same, periodic sideways",
           overfull(box, {Grow{.rate = 0.1}}), overfull(lids, {Grow{.rate = 0.1}})},
          {"several images", "relaxation, alpha = 2, of the same spheres", "column of 1 : 1 : 60",
           "periodic cube", staged(as_column(periodic, 60), {Relax{.alpha = 2}}),
           staged(periodic, {Relax{.alpha = 2}})}};
}

/// Of all seeds.
struct Compared {
  Spread with, without, gain, ratio, seconds_with, seconds_without;
};

Compared compared(const Series& with, const Series& without) {
  std::vector<double> phi_with, phi_without, gain, ratio, seconds_with, seconds_without;
  if (with.trials.empty() || with.trials.size() != without.trials.size())
    throw Error(ErrorCode::bad_argument, with.setting->name + ": it or its counterpart could not be packed");
  for (std::size_t k = 0; k < with.trials.size(); ++k) {
    const Trial &a = with.trials[k], &b = without.trials[k];
    for (const Trial* trial : {&a, &b})
      if (!trial->certified)
        throw Error(ErrorCode::bad_argument, "a packing of the table of effects is not certified");
    phi_with.push_back(a.packing_fraction);
    phi_without.push_back(b.packing_fraction);
    gain.push_back(a.packing_fraction - b.packing_fraction);
    seconds_with.push_back(a.cpu_seconds);
    seconds_without.push_back(b.cpu_seconds);
    ratio.push_back(a.cpu_seconds / std::max(b.cpu_seconds, 1e-6));
  }
  return {spread_of(phi_with), spread_of(phi_without),  spread_of(gain),
          spread_of(ratio),    spread_of(seconds_with), spread_of(seconds_without)};
}

/// What the numbers say, as far as they are larger than their scatter.
std::string sentence(const Compared& c, const std::string& also) {
  const double gain = c.gain.median;
  std::string text =
      std::abs(gain) <= std::max(c.gain.half_width, 5e-4)
          ? std::string("buys no packing fraction that shows beside the scatter")
          : fmt::format("{} {:.4f} of packing fraction", gain > 0 ? "buys" : "costs", std::abs(gain));
  if (!also.empty()) text += "; " + also;
  const double ratio = c.ratio.median;
  text += std::abs(ratio - 1) <= std::max(c.ratio.half_width, 0.05) ? "; takes as long"
          : ratio > 1 ? fmt::format("; takes {:.3g} times as long", ratio)
                      : fmt::format("; takes a share of {:.2g} of the time", ratio);
  return text;
}

std::string plus_minus(const Spread& spread, int digits) {
  return fmt::format("{:.{}f} ± {:.{}f}", spread.median, digits, spread.half_width, digits);
}

}  // namespace

BenchFiles effects(const BenchOptions& options) {
  const std::vector<EffectPair> pairs = all_effects(options);
  std::vector<Setting> settings;
  for (const EffectPair& pair : pairs) {
    settings.push_back({fmt::format("{}: {}", pair.name, pair.on), pair.with});
    settings.push_back({fmt::format("{}: {}", pair.name, pair.off), pair.without});
  }
  RoundOptions rounds_options{.threads = 1, .monitor = options.monitor};
  rounds_options.seeds.clear();
  for (int k = 0; k < seeds_of_an_effect; ++k)
    rounds_options.seeds.push_back(options.seed + static_cast<std::uint64_t>(k));
  TrialRecord record;
  const Rounds rounds = interleaved(settings, record, rounds_options);
  if (rounds.cancelled) return {};

  std::string md = fmt::format(
      "# Effects, one by one\n\nWritten by `bernal bench effects`. Each line is a pair of scenes that differ "
      "in "
      "the effect and in nothing else, packed with {} seeds in turns, one thread: the median and half of "
      "what "
      "lies between the least and the greatest. Packing fractions are those of spheres that do not overlap, "
      "certified; *time* is that of the processor with the effect over that without.\n\n"
      "![what each effect buys and costs](effects.svg)\n\n"
      "| effect | in | with | without | packing fraction with | without | time | that is |\n"
      "|---|---|---|---|--:|--:|--:|---|\n",
      seeds_of_an_effect);
  std::string csv =
      "effect,scenes,with,without,phi_with,phi_with_scatter,phi_without,phi_without_scatter,gain,gain_"
      "scatter,"
      "seconds_with,seconds_without,time_ratio,time_ratio_scatter\n";
  EffectsPicture picture;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const EffectPair& pair = pairs[k];
    const Series &with = rounds.series[2 * k], &without = rounds.series[2 * k + 1];
    const Compared c = compared(with, without);
    const std::string also = pair.also ? pair.also(with.trials[0], without.trials[0]) : "";
    md += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", pair.name, pair.scenes, pair.on,
                      pair.off, plus_minus(c.with, 4), plus_minus(c.without, 4), plus_minus(c.ratio, 2),
                      sentence(c, also));
    csv += fmt::format(
        "\"{}\",\"{}\",\"{}\",\"{}\",{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f}\n",
        pair.name, pair.scenes, pair.on, pair.off, c.with.median, c.with.half_width, c.without.median,
        c.without.half_width, c.gain.median, c.gain.half_width, c.seconds_with.median,
        c.seconds_without.median, c.ratio.median, c.ratio.half_width);
    picture.rows.push_back(
        {std::string(pair.name), c.gain.median, c.gain.half_width, c.ratio.median, c.ratio.half_width});
  }
  return {{"effects.md", md}, {"effects.csv", csv}, {"effects.svg", draw(picture)}};
}

}  // namespace bernal::cost
