#include "plan/hints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"

namespace bernal {
namespace {

/// Of what is expected to fit: fewer leave room that people see.
constexpr double well_below = 0.9;
/// Shares by number and by mass of one class that differ by more are not mistaken for each other.
constexpr double far_apart = 0.1;

/// A periodic box that follows from the packing is as large in any unit.
std::string hint_of_unit(const Plan& plan) {
  const Locations& said = plan.scene.locations;
  if (said.whole.file.empty() || said.keys.contains("unit") || plan.box_follows) return {};
  return fmt::format(
      "no unit is said, and every length is taken to be in {}; say unit = \"mm\" before the "
      "first table where it is not",
      name_of(plan.scene.unit));
}

std::string hint_of_floating(const Plan& plan) {
  const Scene& scene = plan.scene;
  const auto* cylinder = std::get_if<Cylinder>(&scene.container);
  const bool has_floor = !scene.is_periodic() && scene.dimension() == 3 && !(cylinder && cylinder->periodic);
  if (!has_floor || !scene.stages_are_default || scene.target.bed.is_asked() || !scene.target.count ||
      !plan.start.spheres.empty() ||
      plan.expected_packing_fraction > well_below * plan.attainable_packing_fraction)
    return {};
  const auto count = static_cast<std::uint64_t>(*scene.target.count);
  return fmt::format(
      "{} will float in the container, dispersed, and fill {:.2g} of it; say bed = \"poured\" in "
      "[spheres] to have {} lie in it",
      count == 1 ? "1 sphere" : grouped(count) + " spheres", plan.expected_packing_fraction,
      count == 1 ? "it" : "them");
}

std::vector<double> shares_of(std::vector<double> amounts) {
  const double sum = std::accumulate(amounts.begin(), amounts.end(), 0.0);
  for (double& amount : amounts) amount /= sum;
  return amounts;
}

std::string hint_of_shares(const Plan& plan) {
  const SceneSizes& sizes = plan.scene.sizes;
  const auto* classes = std::get_if<Classes>(&sizes);
  constexpr std::size_t most_shown = 6;
  if (!classes || classes->basis != Basis::number || sizes.locations.keys.contains("basis") ||
      classes->values.size() > most_shown)
    return {};
  const std::vector<double> by_number = shares_of(classes->shares);
  std::vector<double> by_mass = classes->shares;
  for (std::size_t k = 0; k < by_mass.size(); ++k)
    by_mass[k] *= std::pow(classes->values[k] / std::ranges::max(classes->values), plan.scene.dimension());
  by_mass = shares_of(by_mass);
  double apart = 0;
  for (std::size_t k = 0; k < by_mass.size(); ++k)
    apart = std::max(apart, std::abs(by_mass[k] - by_number[k]));
  if (apart < far_apart) return {};
  return fmt::format(
      "shares {:.3g} count spheres; by mass they are {:.3g}; say basis = \"volume\" where shares of "
      "the mass are meant",
      fmt::join(by_number, " : "), fmt::join(by_mass, " : "));
}

}  // namespace

std::vector<std::string> hints_of(const Plan& plan) {
  std::vector<std::string> all;
  for (std::string hint : {hint_of_unit(plan), hint_of_floating(plan), hint_of_shares(plan)})
    if (!hint.empty()) all.push_back(std::move(hint));
  return all;
}

}  // namespace bernal
