#include "plan/shortfall.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/dimension.hpp"
#include "core/close_packing.hpp"
#include "plan/estimate.hpp"
#include "plan/few_large.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/stages.hpp"

namespace bernal {
namespace {

/// More than the model has been found above packings of any sizes that have room enough and time.
constexpr double loose_below = 0.05;
/// The packing fraction of equal spheres, for which that was found; where others pack to less, as in more
/// dimensions, it is as large a share of theirs.
constexpr double equal_spheres = random_close_packing[2];
/// Over the number of spheres: few of them jam in the lattice that the box allows, or where chance has it. By
/// how much they missed the model: 5 equal spheres by 0.163, 1 by 0.120, 30 by up to 0.033; relaxed as
/// quickly as can be, 120 lognormal ones by 0.072 and 200 by 0.062.
constexpr double chance_of_few = 3;
/// Share of the volume asked for that may be in spheres of which none is there, because so few were drawn.
constexpr double most_missing = 0.05;
/// Packing fraction from which on a start is as dense as relaxation leaves it.
constexpr double dense_start_from = 0.9 * random_close_packing[2];
/// Radii nearer than this are one size for the model.
constexpr double one_size = 1e-3;
/// Standard deviation of ln r by volume up to which the model was held against simulations: lognormal sizes
/// (Farr 2013, figure 2).
constexpr double tested_width = 0.6;

/// Of the largest spheres from wall to wall: where fewer lie, walls were found to cost more than is expected
/// of the mean size.
constexpr double few_at_walls = 6;

double sum_of_volumes(const std::vector<double>& radii, int dimension) {
  double sum = 0;
  for (const double r : radii) sum += ball_volume(dimension, r);
  return sum;
}

/// As classes, each a share `one_size` wide at most and with the volume that it has.
std::unique_ptr<SizeDistribution> sizes_there(std::vector<double> radii) {
  std::ranges::sort(radii);
  std::vector<double> sizes, numbers;
  for (std::size_t first = 0, last = 0; first < radii.size(); first = last) {
    while (last < radii.size() && radii[last] <= (1 + one_size) * radii[first]) ++last;
    const double n = static_cast<double>(last - first);
    double cubes = 0;
    for (std::size_t i = first; i < last; ++i) cubes += std::pow(radii[i] / radii[first], 3);
    const double mean = radii[last - 1] == radii[first] ? 1 : std::cbrt(cubes / n);
    sizes.push_back(radii[first] * mean);
    numbers.push_back(n);
  }
  if (sizes.size() == 1) return make_constant(sizes.front());
  return make_classes(std::move(sizes), std::move(numbers), Basis::number);
}

double width_by_volume(const std::vector<double>& radii) {
  double volume = 0, sum = 0, squares = 0;
  for (const double r : radii) {
    const double v = r * r * r, x = std::log(r / radii.front());
    volume += v;
    sum += v * x;
    squares += v * x * x;
  }
  return std::sqrt(std::max(0.0, squares / volume - std::pow(sum / volume, 2)));
}

/// A box of the periodic kind in dimensions of which close packing, or what walls leave of it, was measured.
const Box* box_of(const Packing& packing) {
  const Box* box = std::get_if<Box>(&packing.domain);
  const bool is_known = box && box->dimension() >= 2 && box->dimension() <= (box->has_walls() ? 3 : 6) &&
                        packing.scene.is_periodic();
  return is_known && !packing.spheres.empty() ? box : nullptr;
}

/// Close packing of these sizes, less what walls cost.
double expected_in(const Box& box, const Scene& scene, std::vector<double> radii) {
  const std::unique_ptr<SizeDistribution> sizes = sizes_there(std::move(radii));
  if (!box.has_walls()) return close_packing_fraction(*sizes, box.dimension());
  return reached_between_walls(scene, box, *sizes);
}

/// The least of what the packing was to reach, whatever its sizes.
double asked_of(const Packing& packing, const Plan& plan) {
  const Scene& scene = plan.scene;
  double asked = scene.target.packing_fraction.value_or(1);
  if (scene.target.count && !plan.box_follows)
    asked = std::min(asked, sum_of_volumes(packing.spheres.r, scene.dimension()) / volume_of(plan.domain));
  asked = std::min(asked, reached_by_last(scene));
  if (!plan.start.spheres.empty()) {  // a dense one is relaxed from there, a loose one is packed anew
    const double there = sum_of_volumes(plan.start.spheres.r, scene.dimension()) / plan.start.edges.prod();
    if (there >= dense_start_from) asked = std::min(asked, there);
  }
  return asked;
}

/// What the sizes that were asked for pack to, however many of them are drawn; without what stages gain
/// beyond random close packing: a packing is held against that alone.
double ordinarily_attainable(const Plan& plan) {
  const double at_hand =
      plan.attainable_packing_fraction / gain_of_stages(plan.scene, plan.domain, *plan.radii);
  const bool all_drawn = plan.scene.draws() && plan.start.spheres.empty() && coat_of(plan.scene) == 0;
  if (!all_drawn || has_walls(plan.domain)) return at_hand;
  return std::max(at_hand, close_packing_fraction(*plan.radii, plan.scene.dimension()));
}

double error_of(const Plan& plan) {
  return stated_error(plan.scene, plan.domain, *plan.radii, plan.attainable_packing_fraction);
}

/// Of the volume that was asked for, what is in spheres larger than all that are there.
double share_above(const SizeDistribution& radii, double largest, int dimension) {
  constexpr double rounding = 1 + 1e-9;
  return radii.moment_above(dimension, rounding * largest) / radii.moment(dimension);
}

/// What of the sizes makes it less dense: others than were asked for, or too few of the largest.
std::vector<std::string> causes_in_sizes(const Packing& packing, const Plan& plan) {
  std::vector<std::string> causes;
  const double of_sizes = *packing.expected_of_sizes, of_asked = ordinarily_attainable(plan);
  if (of_asked - of_sizes > error_of(plan))
    causes.push_back(fmt::format(
        "the sizes that were drawn pack to {:.3f}, where those asked for pack to {:.3f}{}", of_sizes,
        of_asked, plan.scene.draw == Draw::random ? "; draw = \"quantiles\" comes nearer to these" : ""));
  const Vector<dynamic> edges = std::get<Box>(packing.domain).size;
  const auto count = static_cast<double>(packing.spheres.size());
  if (const auto few = few_large(*sizes_there(packing.spheres.r), count, edges)) {
    const auto of_plan = few_large(*plan.radii, count, edges);
    causes.push_back(in_words(*few) + "; " + remedy_of(of_plan ? *of_plan : *few, count, plan.scene, edges));
  } else if (const double across = largest_across(packing.domain, *plan.radii);
             across < few_at_walls && plan.radii->min() < plan.radii->max()) {
    causes.push_back(
        fmt::format("only {:.2g} of the largest lie between the walls, which take more room from these than "
                    "is expected of all sizes",
                    across));
  }
  return causes;
}

/// What was said to be expected before the radii were drawn, where it is another figure.
std::string before_the_run(const Packing& packing, double expected) {
  const double before = packing.expected_packing_fraction;
  if (expected < *packing.expected_of_sizes || std::abs(before - expected) < 5e-4) return {};
  return fmt::format(" (before they were drawn {:.3f} was)", before);
}

std::string causes_of(const Packing& packing, const Plan& plan) {
  std::vector<std::string> causes = causes_in_sizes(packing, plan);
  const double width = width_by_volume(packing.spheres.r);
  if (causes.empty() && width > tested_width)
    causes.push_back(
        fmt::format("ln r has a standard deviation of {:.2f} by volume, and the model is confirmed up to "
                    "{:.2g}; sizes so wide jam early, unless they are packed slowly",
                    width, tested_width));
  if (causes.empty()) causes.emplace_back("packed more slowly they become denser, as bernal cost tells");
  return fmt::format("{}", fmt::join(causes, "; "));
}

}  // namespace

bool is_loose(double below, double expected, std::uint64_t n) {
  return below >
         (loose_below + chance_of_few / static_cast<double>(n)) * std::min(1.0, expected / equal_spheres);
}

std::optional<double> expected_of_sizes(const Packing& packing) {
  const Box* const box = box_of(packing);
  if (!box) return {};
  const std::vector<double>& radii = packing.spheres.r;
  const double coat = coat_of(packing.scene);
  if (coat == 0) return expected_in(*box, packing.scene, radii);
  std::vector<double> with_coats = radii;
  for (double& r : with_coats) r += coat;
  const double share = sum_of_volumes(radii, box->dimension()) / sum_of_volumes(with_coats, box->dimension());
  return share * expected_in(*box, packing.scene, std::move(with_coats));
}

std::optional<Shortfall> shortfall_of(const Packing& packing, const Plan& plan) {
  if (!packing.expected_of_sizes || !box_of(packing) || any_in_bed(plan.scene) ||
      any_stage(plan.scene, &StageTraits::reaches, Reaches::insertion))  // crystals are what they are
    return {};
  const double of_sizes = *packing.expected_of_sizes, phi = packing.packing_fraction();
  const double expected = std::min(of_sizes, asked_of(packing, plan));
  const double error = error_of(plan);
  Shortfall shortfall{.below = expected - phi};
  if (shortfall.below > error) {
    shortfall.is_loose = is_loose(shortfall.below, expected, packing.spheres.size());
    shortfall.reason = fmt::format(
        "the packing fraction, {:.4f}, is {:.3f} below the {:.3f} to be expected of these sizes{}: {}", phi,
        shortfall.below, expected, before_the_run(packing, expected), causes_of(packing, plan));
    return shortfall;
  }
  if (has_walls(plan.domain)) return {};
  // What is as dense as its sizes become, and these are not those that were asked for.
  const double attainable = ordinarily_attainable(plan);
  const double drawn = std::min(attainable, asked_of(packing, plan)) - phi;
  if (drawn <= error || attainable - of_sizes <= error) return {};
  shortfall.below = drawn;
  shortfall.is_loose =
      is_loose(drawn, attainable, packing.spheres.size()) &&
      share_above(*plan.radii, std::ranges::max(packing.spheres.r), plan.scene.dimension()) > most_missing;
  shortfall.reason = fmt::format("the packing fraction, {:.4f}, is {:.3f} below what was expected: {}", phi,
                                 drawn, fmt::join(causes_in_sizes(packing, plan), "; "));
  return shortfall;
}

}  // namespace bernal
