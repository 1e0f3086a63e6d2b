#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/predict/design.hpp"
#include "commands.hpp"
#include "design.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

struct MaximiseCall {
  std::string diameters;
  std::vector<std::string> lognormals;
  int rods = 16000;
  bool json = false;
};

std::vector<Population> populations_of(const MaximiseCall& call) {
  std::vector<Population> populations;
  if (!call.diameters.empty()) populations = parse_diameters(call.diameters, "--diameters");
  for (const std::string& text : call.lognormals)
    populations.push_back(parse_lognormal_means(text, "--lognormal"));
  if (populations.empty())
    throw Error(ErrorCode::bad_argument,
                "give the populations by --diameters or --lognormal; see bernal design maximise --help");
  if (populations.size() == 1)
    throw Error(ErrorCode::bad_argument,
                "one population alone has no composition; bernal predict says how densely it packs");
  if (populations.size() > most_populations_to_mix)
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} populations; a composition is searched for of no more than {}: put "
                            "neighbouring sizes together, or see bernal design best --help",
                            populations.size(), most_populations_to_mix));
  const auto [least, most] = std::ranges::minmax(populations, {}, &Population::d43);
  require_usable_lengths(least.d43, most.d43);
  if (most.d43 / least.d43 > widest_ratio(call.rods))
    throw Error(
        ErrorCode::bad_argument,
        fmt::format(
            "{} rods stand for sizes no farther apart than 1 : {:.0f}, not for {} and {}; more --rods "
            "reach farther",
            grouped(static_cast<std::uint64_t>(call.rods)), widest_ratio(call.rods), number(least.d43),
            number(most.d43)));
  return populations;
}

Optimum densest(const std::vector<Population>& populations, const SearchOptions& options) {
  const bool lognormal = std::ranges::any_of(populations, [](const Population& p) { return p.sigma > 0; });
  if (lognormal) {
    const MixtureOf mixture = [&](std::span<const double> shares) {
      std::vector<Population> with_shares = populations;
      for (std::size_t k = 0; k < shares.size(); ++k) with_shares[k].volume = shares[k];
      Scene scene;
      scene.sizes = sizes_of(with_shares);
      return radii_of(scene);
    };
    return maximise_packing_fraction(mixture, static_cast<int>(populations.size()), options);
  }
  std::vector<double> radii;
  for (const Population& p : populations) radii.push_back(0.5 * p.d43);
  return maximise_packing_fraction(radii, options);
}

struct MaximiseAnswer {
  std::vector<Population> populations;
  Optimum optimum{};
  std::string table{};
  Prediction prediction{};  ///< of the table, whose shares are rounded
  double seconds = 0;
};

MaximiseAnswer find(const MaximiseCall& call) {
  MaximiseAnswer answer{.populations = populations_of(call)};
  ProgressBar bar(false);
  const Stopwatch watch;
  answer.optimum = densest(answer.populations, {.rods = call.rods, .from = {}, .monitor = bar.monitor()});
  answer.table = mixture_table(answer.populations, answer.optimum.shares);
  answer.prediction = predict_packing_fraction(*sizes_of_table(answer.table), call.rods);
  answer.seconds = watch.seconds();
  return answer;
}

std::string name_of(const Population& p) {
  return p.sigma > 0 ? fmt::format("lognormal, d43 {}, sigma {:.4g}", number(p.d43), p.sigma)
                     : fmt::format("diameter {}", number(p.d43));
}

void print(const MaximiseAnswer& answer) {
  const Optimum& optimum = answer.optimum;
  fmt::print(
      "packing fraction  {:.6f}, random close packing without walls: the densest composition found{}\n",
      answer.prediction.phi, optimum.cancelled ? " before it was stopped" : "");
  std::size_t width = 0;
  for (const Population& p : answer.populations) width = std::max(width, name_of(p).size());
  const char* title = "volume";
  for (std::size_t k = 0; k < answer.populations.size(); ++k, title = "")
    fmt::print("{:<18}{:<{}}  {:7.3f} %\n", title, name_of(answer.populations[k]), width,
               100 * optimum.shares[k]);
  fmt::print(
      "certainty         {} of {} starts of the search ended within 0.00001 of the best, the worst {:.2g} "
      "below\n",
      optimum.agreeing, optimum.starts, optimum.spread);
  print_error_and_table(answer.prediction, answer.table);
}

nlohmann::ordered_json as_json(const MaximiseAnswer& answer) {
  nlohmann::ordered_json json = table_as_json(answer.prediction, answer.table);
  const Optimum& optimum = answer.optimum;
  for (std::size_t k = 0; k < answer.populations.size(); ++k)
    json["populations"].push_back({{"d43", answer.populations[k].d43},
                                   {"sigma", answer.populations[k].sigma},
                                   {"share", optimum.shares[k]}});
  json["starts"] = optimum.starts;
  json["agreeing"] = optimum.agreeing;
  json["spread"] = optimum.spread;
  json["evaluations"] = optimum.evaluations;
  json["cancelled"] = optimum.cancelled;
  json["seconds"] = answer.seconds;
  return json;
}

int maximise(const MaximiseCall& call) {
  const MaximiseAnswer answer = find(call);
  if (call.json)
    fmt::print("{}\n", as_json(answer).dump(2));
  else
    print(answer);
  return answer.optimum.cancelled ? exit_code::not_reached : exit_code::done;
}

Explanation maximise_explanation() {
  return {
      .text =
          "The composition, by volume (or mass, of one material), is searched for from many starts; how many "
          "of "
          "them agree says how certain it is. A size that gets in the way of the others is left out. Where "
          "sizes are near each other many compositions are as good to the model's error, 0.01, and cheaper.",
      .examples = {{"bernal design maximise --diameters 1,5", "20.8 % of the volume small: 0.7878"},
                   {"bernal design maximise --diameters 1,3,9 --json", "three sizes, for programs"},
                   {"bernal design maximise --lognormal 10,9 --lognormal 60,55 --diameters 300",
                    "two wide populations and a size"}},
      .exit_codes = {
          {"0", "done"}, {"2", "bad input"}, {"3", "stopped early, the answer is the best so far"}}};
}

}  // namespace

Command maximise_command() {
  const auto call = std::make_shared<MaximiseCall>();
  return {"maximise",
          "The composition of two to six given populations that packs densest",
          {{"--diameters", &call->diameters, "Populations of one diameter each, in any unit", "D,D,…"},
           repeated({"--lognormal", &call->lognormals,
                     "A lognormal population by its volume- and its surface-weighted mean diameter; as "
                     "often as needed",
                     "D43,D32"}),
           rods_option(call->rods, 100, 10'000'000),
           json_option(call->json)},
          maximise_explanation(),
          [call] { return maximise(*call); }};
}
