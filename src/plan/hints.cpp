#include "plan/hints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/text.hpp"
#include "bernal/settle/insert.hpp"
#include "bernal/sizes/percentiles.hpp"
#include "plan/estimate.hpp"
#include "plan/room_for_gaps.hpp"
#include "scene/porosity.hpp"
#include "scene/size_kinds.hpp"
#include "sizes/volume_carriers.hpp"

namespace bernal {
namespace {

/// Of what is expected to fit: fewer leave room that people see.
constexpr double well_below = 0.9;
/// Shares by number and by mass of one class that differ by more are not mistaken for each other.
constexpr double far_apart = 0.1;
/// Where half of the spheres and half of their volume lie apart by more, the basis matters.
constexpr double basis_matters_from = 1.1;

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
  const bool has_floor = !scene.is_periodic() && scene.dimension() == 3 && !is_periodic(plan.domain);
  if (!has_floor || scene.largest || !scene.stages_are_default || scene.target.bed.is_asked() ||
      !scene.target.count || !plan.start.spheres.empty() ||
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

/// Of spheres lighter than any solid is.
std::string hint_of_density(const Plan& plan) {
  const Scene& scene = plan.scene;
  const auto* classes = std::get_if<Classes>(&scene.sizes);
  if (classes && !classes->material_densities.empty())
    return doubt_of_density("material_densities", std::ranges::max(classes->material_densities));
  return scene.material_density ? doubt_of_density("material_density", *scene.material_density)
                                : std::string();
}

/// Of sizes with a basis, of which the scene's text says none; classes have their own hint, and percentiles
/// say theirs with their law.
std::string hint_of_basis(const Plan& plan) {
  const SceneSizes& sizes = plan.scene.sizes;
  const bool counts_spheres = std::visit(
      [](const auto& of) {
        if constexpr (requires { of.basis; }) return of.basis == Basis::number;
        return false;
      },
      static_cast<const SceneSizes::variant&>(sizes));
  const auto* lognormal = std::get_if<Lognormal>(&sizes);
  if (!counts_spheres || std::holds_alternative<Classes>(sizes) || (lognormal && lognormal->d43) ||
      sizes.locations.whole.line == 0 || sizes.locations.keys.contains("basis"))
    return {};
  const int dimension = plan.scene.dimension();
  const double by_number = 2 * plan.radii->quantile(0.5);
  const double by_volume = 2 * radius_holding(*plan.radii, 0.5, dimension);
  if (!(by_volume > basis_matters_from * by_number)) return {};
  return fmt::format(
      "no basis is said, and \"number\" is meant: half of the spheres are below {:.4g} {}, half of their {} "
      "below {:.4g}; say basis = \"volume\" where the sizes are those of a balance",
      by_number, name_of(plan.scene.unit), dimension == 2 ? "area" : "volume", by_volume);
}

std::string hint_of_pan(const Plan& plan) {
  const auto* sieve = std::get_if<Sieve>(&plan.scene.sizes);
  if (!sieve || sieve->pan) return {};
  const SieveCurve curve = curve_of(*sieve);
  if (curve.in_pan == 0) return {};
  const double scale = plan.scene.scale;
  return fmt::format(
      "the {:.3g} % in the pan are taken to be {:.4g} to {:.4g} {}, from half of the finest sieve on; "
      "\"pan\" says how fine they are",
      100 * curve.in_pan, scale * curve.pan, scale * curve.openings[1], name_of(plan.scene.unit));
}

std::string hint_of_ends(const Plan& plan) {
  const auto* given = std::get_if<Percentiles>(&plan.scene.sizes);
  if (!given || given->law != PercentileLaw::through || (given->min && given->max)) return {};
  const auto curve = curve_through(given_percentiles(*given), given->min.value_or(0),
                                   given->max.value_or(std::numeric_limits<double>::infinity()));
  const double scale = plan.scene.scale;
  return fmt::format(
      "the sizes are taken to end at {:.4g} and {:.4g} {}, where the curve through the outermost percentiles "
      "goes on straight; \"min\" and \"max\" say where",
      scale * curve.front().size, scale * curve.back().size, name_of(plan.scene.unit));
}

/// Of a part with places that no sphere reaches. What is narrower than a sphere of radius r has an area of at
/// least V / r, so that mostly nothing has to be looked at.
std::string hint_of_narrow_parts(const Plan& plan) {
  constexpr double worth_telling = 0.1, quantile_of_smallest = 0.01;
  if (!is_faceted(plan.domain) || plan.scene.dimension() != 3) return {};
  const double r = std::max(plan.radii->min(), plan.radii->quantile(quantile_of_smallest));
  if (r * area_of(plan.domain) < worth_telling * volume_of(plan.domain)) return {};
  const double reached = coverable_share(*local_container(plan.domain, plan.container),
                                         (r + coat_of(plan.scene)) / frame_of(plan.domain).scale);
  if (1 - reached < worth_telling) return {};
  return fmt::format(
      "about {:.2g} % of the container is too narrow for even the smallest spheres: thin parts, "
      "edges and corners; smaller ones reach more of it",
      100 * (1 - reached));
}

/// Of equal spheres that are to fill a container, where a crystal is likely to hold more.
std::string hint_of_crystal(const Plan& plan) {
  constexpr double worth_telling = 1.01;
  const Scene& scene = plan.scene;
  if (!scene.target.fill || !std::holds_alternative<Constant>(scene.sizes) || scene.dimension() != 3 ||
      !has_walls(plan.domain) || !scene.stages_are_default || !plan.start.spheres.empty())
    return {};
  Scene crystal = scene;
  crystal.stages = {Insert{.layout = Layout::fcc}};
  const double reached = expected_packing_fraction(crystal, plan.domain, *plan.radii, plan.container);
  if (!(reached > worth_telling * plan.expected_packing_fraction)) return {};
  return fmt::format(
      "a face-centred crystal may hold more of these equal spheres, about {:.2g} of the volume in place of "
      "{:.2g}: say [[stage]] with do = \"insert\" and layout = \"fcc\"",
      reached, plan.expected_packing_fraction);
}

/// Of spheres from a packing that has more than spheres.
std::string hint_of_start(const Plan& plan) {
  if (plan.start.left_out.empty()) return {};
  return fmt::format("the start gives places and sizes of spheres alone; left out: {}", plan.start.left_out);
}

}  // namespace

std::vector<std::string> hints_of(const Plan& plan) {
  std::vector<std::string> all;
  for (std::string hint : {hint_of_unit(plan), hint_of_floating(plan), hint_of_shares(plan),
                           hint_of_density(plan), hint_of_basis(plan), hint_of_pan(plan), hint_of_ends(plan),
                           hint_of_narrow_parts(plan), hint_of_crystal(plan), hint_of_start(plan)})
    if (!hint.empty()) all.push_back(std::move(hint));
  return all;
}

}  // namespace bernal
