// Every method on the same spheres: what it reaches, and in what time.
#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/fly/fly.hpp"
#include "bernal/hard/grow.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/soft/relax.hpp"
#include "cost/bench_tables.hpp"
#include "cost/methods_picture.hpp"
#include "cost/rounds.hpp"

namespace bernal::cost {
namespace {

/// Seconds of a run, on the wall, after which a method counts as too slow for the picture.
constexpr double slowest = 15;
constexpr int until_full = 200;

/// A method with the knob that trades time for packing fraction.
struct Method {
  std::string_view name;
  std::string_view knob;
  std::vector<double> ladder;
  std::function<void(Scene&, double value, const SizeClass&, double predicted)> set;
  Sides sides = Sides::none;
  bool only_wide = false;
};

Grow growth(double rate, const SizeClass& sizes) {
  return {.rate = rate, .masses = sizes.wide ? Masses::by_volume : Masses::equal};
}

auto relaxed_by(RelaxMethod method) {
  return [method](Scene& scene, double alpha, const SizeClass&, double) {
    scene.stages = {Relax{.alpha = alpha, .method = method}};
  };
}

auto filled_by(FillMethod method) {
  return [method](Scene& scene, double share, const SizeClass&, double predicted) {
    scene.target.packing_fraction = share * predicted;
    scene.stages = {Fly{.method = method}};
  };
}

auto compressed(double tilt, int shakes) {
  return [=](Scene& scene, double rounds, const SizeClass&, double) {
    const Compress compress{.tilt = tilt};
    scene.target.fill = true;
    scene.stages = {
        Insert{}, compress,
        Refill{.max_rounds = static_cast<int>(rounds), .shake = {.rounds = shakes, .compress = compress}}};
  };
}

std::vector<Method> all_methods() {
  const std::vector<double> rounds = {1, 2, 4, 8, until_full};
  return {
      {"relaxation", "alpha", {1, 2, 5, 17, 50}, relaxed_by(RelaxMethod::fast)},
      {"relaxation, as published", "alpha", {1, 2, 5}, relaxed_by(RelaxMethod::reference)},
      {"growth",
       "rate",
       {0.3, 0.1, 0.03, 0.01},
       [](Scene& scene, double rate, const SizeClass& sizes, double) {
         scene.stages = {growth(rate, sizes)};
       }},
      {"filling by relaxation", "share", {0.90, 0.95, 0.98}, filled_by(FillMethod::relaxation)},
      {"filling by classes", "share", {0.75, 0.83, 0.90}, filled_by(FillMethod::classes), Sides::none, true},
      {"filling in flight", "share", {0.55, 0.62, 0.68}, filled_by(FillMethod::flight)},
      {"filling, as patented", "share", {0.45, 0.52, 0.57}, filled_by(FillMethod::patent)},
      {"relaxation",
       "share",
       {0.82, 0.87, 0.91, 0.94},
       [](Scene& scene, double share, const SizeClass&, double predicted) {
         scene.target.packing_fraction = share * predicted;
         scene.stages = {Relax{}};
       },
       Sides::lids},
      {"growth",
       "rate",
       {0.2, 0.06, 0.02},
       [](Scene& scene, double rate, const SizeClass& sizes, double predicted) {
         scene.target.packing_fraction = share_that_jams * predicted;
         scene.stages = {growth(rate, sizes)};
       },
       Sides::lids},
      {"compression straight down", "rounds", rounds, compressed(0, 0), Sides::lids},
      {"compression with tilt", "rounds", rounds, compressed(2, 0), Sides::lids},
      {"compression with tilt and shaking", "rounds", rounds, compressed(2, 1), Sides::lids}};
}

std::string_view meaning(std::string_view knob) {
  if (knob == "alpha") return "sweeps between two growths of the box, in units of (log10 N)²";
  if (knob == "rate") return "growth of the mean diameter over the thermal speed";
  if (knob == "share") return "the packing fraction that is asked for, in shares of the predicted one";
  return "refillings at most";
}

/// A method with one value of its knob.
struct Rung {
  std::size_t method;
  double value;
  std::size_t setting;
};

struct Ladders {
  SizeClass sizes;
  double predicted = 0;
  std::int64_t count = 0;
  std::vector<Rung> rungs;
};

std::string value_text(const Method& method, double value) {
  return method.knob == "rounds" && value == until_full ? "until full" : fmt::format("{}", value);
}

/// Median and half the range, of trials that came to their end. Where a packing fraction is asked for, what
/// was not reached by one of them is nothing that the method reaches.
struct Reached {
  Spread phi, core, seconds;
  std::size_t trials = 0;
  bool with_core = false;
};
Reached reached_by(const Series& series, const Method& method) {
  std::vector<double> phi, core, seconds;
  for (const Trial& trial : series.trials) {
    if (trial.cut_off) continue;
    if (method.knob == "share" && trial.outcome != Outcome::converged) return {};
    if (!trial.certified)
      throw Error(ErrorCode::bad_argument, series.setting->name + ": the packing is not certified");
    phi.push_back(trial.packing_fraction);
    seconds.push_back(trial.cpu_seconds);
    if (trial.core_packing_fraction) core.push_back(*trial.core_packing_fraction);
  }
  if (phi.empty()) return {};
  return {spread_of(phi), core.empty() ? Spread{} : spread_of(core), spread_of(seconds), phi.size(),
          !core.empty()};
}

std::string with_scatter(const Spread& spread) {
  return fmt::format("{:.4f} ± {:.4f}", spread.median, spread.half_width);
}

std::string csv_of(const Ladders& ladders, const std::vector<Method>& methods, const Rounds& rounds) {
  std::string csv;
  for (const Rung& rung : ladders.rungs) {
    const Method& method = methods[rung.method];
    for (const Trial& t : rounds.series[rung.setting].trials) {
      csv += fmt::format("{},{},\"{}\",{},{},{},{},", ladders.sizes.name,
                         method.sides == Sides::none ? "none" : "lids", method.name, method.knob, rung.value,
                         t.seed, t.spheres);
      csv += t.cut_off ? ",," : fmt::format("{:.6f},", t.packing_fraction);
      if (!t.cut_off) csv += t.core_packing_fraction ? fmt::format("{:.4f},", *t.core_packing_fraction) : ",";
      csv += fmt::format("{:.4f},{},{:.6f}\n", t.cpu_seconds, t.cut_off ? "cut_off" : name_of(t.outcome),
                         ladders.predicted);
    }
  }
  return csv;
}

/// One method has one colour in all pictures.
int colour_of(const std::vector<Method>& methods, std::size_t method) {
  std::vector<std::string_view> names;
  for (const Method& m : methods)
    if (std::ranges::find(names, m.name) == names.end()) names.push_back(m.name);
  return static_cast<int>(std::ranges::find(names, methods[method].name) - names.begin());
}

/// The densest, and the first that is nearly as dense, of what packs in one of the rooms.
std::string summary_of(const Ladders& ladders, const std::vector<Method>& methods, const Rounds& rounds,
                       Sides sides) {
  constexpr double nearly = 0.01;
  const Rung *densest = nullptr, *soonest = nullptr;
  const auto reached = [&](const Rung* rung) {
    return reached_by(rounds.series[rung->setting], methods[rung->method]);
  };
  const auto of_room = [&](const Rung& rung) {
    return methods[rung.method].sides == sides && reached(&rung).trials > 0;
  };
  for (const Rung& rung : ladders.rungs)
    if (of_room(rung) && (!densest || reached(&rung).phi.median > reached(densest).phi.median))
      densest = &rung;
  if (!densest) return "";
  for (const Rung& rung : ladders.rungs)
    if (of_room(rung) && reached(&rung).phi.median >= reached(densest).phi.median - nearly &&
        (!soonest || reached(&rung).seconds.median < reached(soonest).seconds.median))
      soonest = &rung;
  const auto text = [&](const Rung* rung) {
    const Method& method = methods[rung->method];
    return fmt::format("{} ({} {}), {:.4f} in {:.2g} s", method.name, method.knob,
                       value_text(method, rung->value), reached(rung).phi.median,
                       reached(rung).seconds.median);
  };
  return fmt::format("{}: densest by {}{}. ",
                     sides == Sides::none ? "Without walls" : "Between floor and lid", text(densest),
                     soonest == densest ? ", and nothing is within 0.01 of that sooner"
                                        : "; within 0.01 of that soonest by " + text(soonest));
}

std::string table_of(const Ladders& ladders, const std::vector<Method>& methods, const Rounds& rounds) {
  std::string text = fmt::format(
      "\n## {}\n\n{} spheres, without walls and between floor and lid; predicted by the rod model: "
      "{:.4f}. {}{}\n\n"
      "![packing fraction over seconds](methods_{}.svg)\n\n"
      "| where | method | knob | packing fraction | in the core | seconds |\n|---|---|---|--:|--:|--:|\n",
      ladders.sizes.title, grouped(static_cast<std::uint64_t>(ladders.count)), ladders.predicted,
      summary_of(ladders, methods, rounds, Sides::none), summary_of(ladders, methods, rounds, Sides::lids),
      ladders.sizes.name);
  for (const Rung& rung : ladders.rungs) {
    const Method& method = methods[rung.method];
    const Reached reached = reached_by(rounds.series[rung.setting], method);
    const std::string begin =
        fmt::format("| {} | {} | {} {} | ", method.sides == Sides::none ? "periodic" : "floor and lid",
                    method.name, method.knob, value_text(method, rung.value));
    const bool all_cut_off = std::ranges::all_of(rounds.series[rung.setting].trials, &Trial::cut_off);
    if (reached.trials == 0)
      text += begin + (all_cut_off ? fmt::format("| | more than {:g} |\n", slowest) : "not reached | | |\n");
    else
      text += begin + fmt::format("{} | {} | {:.3g} |\n", with_scatter(reached.phi),
                                  reached.with_core ? fmt::format("{:.3f}", reached.core.median) : "",
                                  reached.seconds.median);
  }
  return text;
}

BenchFile picture_of(const Ladders& ladders, const std::vector<Method>& methods, const Rounds& rounds) {
  MethodsPicture picture{std::string(ladders.sizes.title), ladders.predicted, {}};
  for (std::size_t m = 0; m < methods.size(); ++m) {
    MethodsPicture::Line line{
        std::string(methods[m].name), colour_of(methods, m), methods[m].sides != Sides::none, {}};
    for (const Rung& rung : ladders.rungs) {
      if (rung.method != m) continue;
      const Reached reached = reached_by(rounds.series[rung.setting], methods[m]);
      if (reached.trials > 0)
        line.points.push_back({reached.seconds.median, reached.phi.median, reached.phi.half_width});
    }
    if (!line.points.empty()) picture.lines.push_back(std::move(line));
  }
  return {fmt::format("methods_{}.svg", ladders.sizes.name), draw(picture)};
}

}  // namespace

BenchFiles methods(const BenchOptions& options) {
  const SizeClass all[] = {equal_sizes(), lognormal_sizes(), one_to_five()};
  return methods_of(all, options);
}

BenchFiles methods_of(std::span<const SizeClass> size_classes, const BenchOptions& options) {
  const std::vector<Method> methods = all_methods();
  std::vector<Ladders> all;
  std::vector<Setting> settings;
  for (const SizeClass& sizes : size_classes) {
    Ladders ladders{sizes, predicted_for(sizes), sizes.count_for(options.spheres), {}};
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Method& method = methods[m];
      if (method.only_wide && !sizes.wide) continue;
      for (const double value : method.ladder) {
        Scene scene = room_for(sizes, ladders.count, method.sides, share_between_lids * ladders.predicted);
        method.set(scene, value, sizes, ladders.predicted);
        ladders.rungs.push_back({m, value, settings.size()});
        settings.push_back({fmt::format("{}, {} {}", sizes.title, method.name, value),
                            std::move(scene),
                            {},
                            method.sides != Sides::none});
      }
    }
    all.push_back(std::move(ladders));
  }

  TrialRecord record;
  const Rounds rounds = interleaved(settings, record,
                                    {.seeds = {options.seed, options.seed + 1},
                                     .threads = 1,
                                     .limit = slowest,
                                     .monitor = options.monitor});
  if (rounds.cancelled) return {};

  std::string md =
      "# Methods, priced\n\nWritten by `bernal bench methods`. Packing fractions are those of spheres that "
      "do "
      "not overlap, certified; seconds are of the processor, one thread. The median of two seeds, ± half of "
      "what lies between them.\n\n";
  for (const std::string_view knob : {"alpha", "rate", "share", "rounds"})
    md += fmt::format("- *{}*: {}.\n", knob, meaning(knob));
  md +=
      "\nWhere there are a floor and a lid the box repeats itself sideways, and the spheres next to the two "
      "walls pack less densely than those of the core, which stands beside: that is the walls' doing, not "
      "the method's.\n";
  std::string csv =
      "sizes,walls,method,knob,value,seed,spheres,packing_fraction,core_packing_fraction,seconds,outcome,"
      "predicted\n";
  BenchFiles files;
  for (const Ladders& ladders : all) {
    md += table_of(ladders, methods, rounds);
    csv += csv_of(ladders, methods, rounds);
    files.push_back(picture_of(ladders, methods, rounds));
  }
  files.insert(files.begin(), {{"methods.md", md}, {"methods.csv", csv}});
  return files;
}

}  // namespace bernal::cost
