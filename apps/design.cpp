#include "design.hpp"

#include <cmath>
#include <cstdint>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"

using namespace bernal;

std::string number(double value) { return fmt::format("{}", std::stod(fmt::format("{:.10g}", value))); }

void require_usable_lengths(double smallest, double largest) {
  if (!(smallest >= 1e-20 && largest <= 1e20))
    throw Error(ErrorCode::bad_argument,
                fmt::format("diameters must lie from 1e-20 to 1e20, but are {} and {}; choose another unit",
                            smallest, largest));
}

double rounded_share(double share) { return std::round(share * 1e6) / 1e6; }

std::string mixture_table(const std::vector<Population>& populations, const std::vector<double>& shares) {
  // By diameter and width, so that equal ones meet.
  std::map<std::pair<double, double>, double> of;
  for (std::size_t k = 0; k < populations.size(); ++k)
    if (rounded_share(shares[k]) > 0) of[{populations[k].d43, populations[k].sigma}] += shares[k];

  std::vector<std::string> members, amounts;
  bool lognormal = false;
  for (const auto& [population, share] : of) {
    const auto [d43, sigma] = population;
    lognormal = lognormal || sigma > 0;
    // d43 = median by volume e^(sigma²/2)
    members.push_back(sigma > 0 ? fmt::format("{{ distribution = \"lognormal\", median = {}, sigma = {}, "
                                              "basis = \"volume\" }}",
                                              number(d43 * std::exp(-0.5 * sigma * sigma)), number(sigma))
                                : number(d43));
    amounts.push_back(fmt::format("{}", rounded_share(share)));
  }
  if (members.size() == 1)
    return lognormal ? members[0] : fmt::format("{{ distribution = \"constant\", value = {} }}", members[0]);
  return fmt::format("{{ distribution = \"{}\", {} = [{}], shares = [{}], basis = \"volume\" }}",
                     lognormal ? "mixture" : "classes", lognormal ? "of" : "values", fmt::join(members, ", "),
                     fmt::join(amounts, ", "));
}

std::unique_ptr<SizeDistribution> sizes_of_table(const std::string& table) {
  return radii_of(parse_scene(fmt::format("unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [1, 1, 1]\n"
                                          "[spheres]\ncount = 1\ndiameter = {}\n",
                                          table),
                              "the answer"));
}

void print_error(const Prediction& prediction) {
  fmt::print("error             {:.1g}, from having {} rods{}\n", prediction.error,
             grouped(static_cast<std::uint64_t>(prediction.rods)),
             prediction.error > 1e-3 ? "; more --rods would help" : "; that of the model is about 0.01");
}

void print_error_and_table(const Prediction& prediction, const std::string& table) {
  print_error(prediction);
  fmt::print("\nTo paste under [spheres] of a scene:\ndiameter = {}\n", table);
}

nlohmann::ordered_json table_as_json(const Prediction& prediction, const std::string& table) {
  return {{"phi", prediction.phi},
          {"error", prediction.error},
          {"rods", prediction.rods},
          {"diameter", table},
          {"scene_line", "diameter = " + table}};
}

Command design_command() {
  return {
      "design",
      "Find the sizes that pack densest, or as densely as asked, and how dense layers need them",
      {},
      {.text = "Each ends with a line to paste under [spheres] of a scene, \"diameter = { … }\" or "
               "\"packing_fraction = …\". All of it "
               "by the rod model: see bernal predict for what that is worth.",
       .examples = {{"bernal design maximise --diameters 1,3,9", "how much of each packs densest: 0.8336"},
                    {"bernal design target --phi 0.7 --family lognormal", "how wide: sigma = 0.4619"},
                    {"bernal design best --min 1 --max 10", "the densest sizes between two limits"}}},
      {},
      {maximise_command(), target_command(), best_command(), layer_command()}};
}
