#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/predict/design.hpp"
#include "commands.hpp"
#include "design.hpp"
#include "design_families.hpp"
#include "progress_bar.hpp"

using namespace bernal;

namespace {

/// The least gain in packing fraction for which one more size is worth having; the model's error is 0.01.
constexpr double worth_a_size = 0.002;
constexpr std::size_t most_sizes = 5;

struct BestCall {
  double min = 0, max = 0;
  int bins = 16;
  int rods = 16000;
  bool json = false;
};

struct BestAnswer {
  DensestDensity density{};
  DensestSizes sizes{};
  std::string density_table{}, sizes_table{};
  Prediction density_prediction{}, sizes_prediction{};  ///< of the tables, whose shares are rounded
  double seconds = 0;
};

/// The bins as a sieve analysis, without the limits between empty bins.
std::string sieve_table(const DensestDensity& density) {
  std::vector<std::string> sizes, passing;
  const std::vector<double>& shares = density.optimum.shares;
  double passed = 0;
  for (std::size_t k = 0; k < density.radii.size(); ++k) {
    const bool last = k == shares.size();
    const bool needed = k == 0 || last || shares[k - 1] > 0 || shares[k] > 0;
    if (needed) {
      sizes.push_back(number(2 * density.radii[k]));
      passing.push_back(last ? "100" : number(100 * rounded_share(passed)));
    }
    if (!last) passed += shares[k];
  }
  return fmt::format("{{ distribution = \"sieve\", sizes = [{}], passing = [{}] }}", fmt::join(sizes, ", "),
                     fmt::join(passing, ", "));
}

std::string classes_table(const DensestSizes& sizes) {
  std::vector<Population> populations;
  for (const double radius : sizes.radii) populations.push_back({.d43 = std::stod(number(2 * radius))});
  return mixture_table(populations, sizes.optimum.shares);
}

BestAnswer find(const BestCall& call) {
  const SizeLimits limits = limits_of(call.min, call.max, {});
  ProgressBar bar(false);
  SearchOptions options{.rods = call.rods, .from = {}, .monitor = bar.monitor(0, 0.4)};
  const Stopwatch watch;
  const double min = 0.5 * *limits.min, max = 0.5 * *limits.max;
  BestAnswer answer;
  answer.density = densest_density(min, max, call.bins, options);
  options.monitor = bar.monitor(0.4, 0.45);
  answer.sizes = densest_sizes(min, max, 2, options);
  for (int count = 3; count <= static_cast<int>(most_sizes) && !interrupted(); ++count) {
    const auto done = [](int sizes) { return 0.25 + 0.02 * sizes * sizes; };  // each takes longer
    options.monitor = bar.monitor(done(count), done(count + 1));
    const DensestSizes more = densest_sizes(min, max, count, options);
    if (more.optimum.prediction.phi < answer.sizes.optimum.prediction.phi + worth_a_size) break;
    answer.sizes = more;
  }
  answer.density_table = sieve_table(answer.density);
  answer.sizes_table = classes_table(answer.sizes);
  answer.density_prediction = predict_packing_fraction(*sizes_of_table(answer.density_table), options.rods);
  answer.sizes_prediction = predict_packing_fraction(*sizes_of_table(answer.sizes_table), options.rods);
  answer.seconds = watch.seconds();
  return answer;
}

void print_certainty(const Optimum& optimum, double within) {
  fmt::print("  certainty       {} of {} starts ended within {} of the best, the worst {:.2g} below{}\n",
             optimum.agreeing, optimum.starts, within, optimum.spread,
             optimum.cancelled ? "; stopped early" : "");
}

void print(const BestAnswer& answer) {
  const DensestDensity& density = answer.density;
  fmt::print("density           {:.6f}, random close packing without walls, by volume in {} bins\n",
             answer.density_prediction.phi, density.levels.back().bins);
  std::string finer;
  for (const DensestDensity::Level& level : density.levels)
    finer += fmt::format("{}{} bins {:.4f}", finer.empty() ? "" : ", ", level.bins, level.phi);
  fmt::print("  finer bins      {}\n", finer);
  fmt::print("  power law       {:.4f} at best, of exponent {:.2f}\n", density.power_law_phi,
             density.power_law_exponent);
  print_certainty(density.optimum, 1e-4);
  const std::size_t count = answer.sizes.radii.size();
  fmt::print("{:<18}{:.6f}; {}\n", fmt::format("{} sizes", count), answer.sizes_prediction.phi,
             count < most_sizes ? fmt::format("one more would gain less than {}", worth_a_size)
                                : "more were not tried");
  print_certainty(answer.sizes.optimum, 1e-5);
  if (answer.sizes_prediction.phi > answer.density_prediction.phi)
    fmt::print(
        "\nA few sizes pack denser than the density: the narrower its bins, the more it gathers into peaks "
        "like them.\n");
  print_error_and_table(answer.density_prediction, answer.density_table);
  fmt::print("or, the few sizes:\ndiameter = {}\n", answer.sizes_table);
}

nlohmann::ordered_json certainty_as_json(nlohmann::ordered_json json, const Optimum& optimum) {
  json["starts"] = optimum.starts;
  json["agreeing"] = optimum.agreeing;
  json["spread"] = optimum.spread;
  json["cancelled"] = optimum.cancelled;
  return json;
}

nlohmann::ordered_json as_json(const BestAnswer& answer) {
  const DensestDensity& density = answer.density;
  nlohmann::ordered_json json =
      certainty_as_json(table_as_json(answer.density_prediction, answer.density_table), density.optimum);
  for (const DensestDensity::Level& level : density.levels)
    json["levels"].push_back({{"bins", level.bins}, {"phi", level.phi}});
  json["power_law"] = {{"phi", density.power_law_phi}, {"exponent", density.power_law_exponent}};
  json["few_sizes"] =
      certainty_as_json(table_as_json(answer.sizes_prediction, answer.sizes_table), answer.sizes.optimum);
  json["seconds"] = answer.seconds;
  return json;
}

int best(const BestCall& call) {
  const BestAnswer answer = find(call);
  if (call.json)
    fmt::print("{}\n", as_json(answer).dump(2));
  else
    print(answer);
  const bool cancelled = answer.density.optimum.cancelled || answer.sizes.optimum.cancelled;
  return cancelled ? exit_code::not_reached : exit_code::done;
}

Explanation best_explanation() {
  return {
      .text =
          "There is no densest density. With more bins the best one is denser and gathers into narrow peaks, "
          "whose limit is a few sizes; what it gained with each doubling of the bins is told, and what the "
          "best "
          "power law (Fuller's is of exponent 0.5) reaches. Real fractions have a width: choose bins as wide "
          "as "
          "yours.",
      .lists = {{.title = "Answers",
                 .text = "two, each with a table to paste into a scene.",
                 .entries = {{"density",
                              "by volume, constant in bins that are evenly spaced on a logarithmic "
                              "axis (a sieve analysis)"},
                             {"sizes",
                              "two to five, the limits among them: as many as gain at least 0.002 "
                              "each"}}}},
      .examples = {{"bernal design best --min 1 --max 10", "0.8313 in 16 bins, 0.8407 with three sizes"},
                   {"bernal design best --min 0.063 --max 2 --bins 8 --json", "of a sand, for programs"}},
      .exit_codes = {
          {"0", "done"}, {"2", "bad input"}, {"3", "stopped early, the answer is the best so far"}}};
}

}  // namespace

Command best_command() {
  const auto call = std::make_shared<BestCall>();
  return {"best",
          "The sizes between two limits that pack densest",
          {required({"--min", &call->min, "The smallest diameter, in any unit", "D"}),
           required({"--max", &call->max, "The largest diameter, in the same unit", "D"}),
           one_of({"--bins", &call->bins, "Of the density: 2, 4, 8, 16, 32 or 64; 16 if absent", "N"},
                  {"2", "4", "8", "16", "32", "64"}),
           rods_option(call->rods, 100, 10'000'000), json_option(call->json)},
          best_explanation(),
          [call] { return best(*call); }};
}
