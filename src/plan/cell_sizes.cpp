#include "plan/cell_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "measure/weighted_cells.hpp"
#include "plan/estimate.hpp"
#include "plan/made_plan.hpp"
#include "plan/start.hpp"

namespace bernal {
namespace {

/// Measured: all cells of a sphere, in two threads, and how often the weights ask for them.
constexpr double seconds_a_cell = 30e-6, bytes_a_cell = 2000;
constexpr double diagrams = 10;
/// With which the first plan begins.
constexpr double usual_packing_fraction = 0.6;
/// Scales that a reader should hear of.
constexpr double change_worth_telling = 2e-3;

bool box_follows(const Scene& scene) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  return box && box->scalable;
}

std::vector<double> radii_in(const std::vector<double>& volumes, double packing_fraction) {
  std::vector<double> radii;
  for (const double volume : volumes) radii.push_back(radius_in_cell(volume, packing_fraction));
  return radii;
}

/// What stages surely place in a box of given size.
double surely_reached(const Plan& plan) {
  const double expected = plan.attainable_packing_fraction;
  return std::max(0.5 * expected,
                  expected - error_of_expectation(plan.scene, plan.domain, *plan.radii, expected));
}

}  // namespace

double StatedCells::volume_of(double size) const { return are_volumes ? size : ball_volume(3, size); }

double StatedCells::size_of(double volume) const {
  return are_volumes ? volume : std::cbrt(0.75 / std::numbers::pi * volume);
}

double StatedCells::mean_volume() const {
  return are_volumes ? sizes->moment(1) : ball_volume(3, 1) * sizes->moment(3);
}

std::vector<double> StatedCells::volumes(std::size_t count) const {
  std::vector<double> all;
  all.reserve(count);
  for (std::size_t k = 0; k < count; ++k)
    all.push_back(volume_of(sizes->quantile((static_cast<double>(k) + 0.5) / static_cast<double>(count))));
  return all;
}

StatedCells stated_cells_of(const Scene& scene) {
  Scene of;
  of.sizes = scene.cells->sizes();
  of.sizes_are_diameters = scene.cells->diameter.has_value();
  return {radii_of(of), scene.cells->volume.has_value()};
}

std::unique_ptr<SizeDistribution> first_radii_of(const Scene& scene) {
  constexpr std::int64_t most = 1000;
  const std::int64_t count = std::min(most, scene.target.count.value_or(most));
  return radii_there(radii_in(stated_cells_of(scene).volumes(static_cast<std::size_t>(count)),
                              scene.target.packing_fraction.value_or(usual_packing_fraction)));
}

double radius_in_cell(double volume, double packing_fraction) {
  return std::cbrt(0.75 / std::numbers::pi * packing_fraction * volume);
}

Scene scene_of_radii(const Scene& scene, std::vector<double> radii) {
  Scene made = scene;
  made.cells.reset();
  made.target.count = static_cast<std::int64_t>(radii.size());
  if (!box_follows(scene)) {
    made.target.packing_fraction.reset();
    made.target.predicted = false;
  }
  made.draw.reset();
  made.sizes_are_diameters = false;
  made.sizes = ListedSizes{.values = std::move(radii)};
  made.sizes.locations = scene.cells->locations;
  return made;
}

Plan plan_of_cells(const Scene& stated) {
  Scene scene = stated;
  complete(scene);
  const StatedCells cells = stated_cells_of(scene);
  const double room = volume_of(domain_of(scene));
  std::optional<std::int64_t>& count = scene.target.count;
  if (!count) {
    const double fit = std::round(room / cells.mean_volume());
    if (!(fit >= 1 && fit < 0x1p31))
      throw Error(ErrorCode::bad_scene,
                  fmt::format("{:.3g} cells of this mean volume, {:.4g}, fill the box: check the units, or "
                              "give \"count\" in [spheres]",
                              fit, cells.mean_volume()),
                  scene.cells->locations.whole);
    count = static_cast<std::int64_t>(fit);
  }
  std::vector<double> volumes = cells.volumes(static_cast<std::size_t>(*count));
  const bool follows = box_follows(scene);
  const double scale = follows ? 1 : room / std::accumulate(volumes.begin(), volumes.end(), 0.0);
  for (double& volume : volumes) volume *= scale;

  double phi = scene.target.packing_fraction.value_or(usual_packing_fraction);
  Plan plan = made_plan(scene_of_radii(scene, radii_in(volumes, phi)));
  if (!scene.target.packing_fraction) {
    phi = follows ? plan.expected_packing_fraction : surely_reached(plan);
    plan = made_plan(scene_of_radii(scene, radii_in(volumes, phi)));
  }
  if (std::abs(scale - 1) > change_worth_telling)
    plan.hints.push_back(
        fmt::format("{} cells of these sizes have {:.4g} times the volume of the box: the "
                    "volumes are all {:.4g} times as large",
                    grouped(static_cast<std::uint64_t>(*count)), 1 / scale, scale));
  const auto n = static_cast<double>(*count);
  const int rounds = scene.cells->rounds;
  const double packing_again = rounds * plan.expected_seconds;
  plan.items.push_back({.name = std::string(cells_effect),
                        .what = fmt::format("the weights of cells of the volumes asked for; the spheres are "
                                            "packed up to {} times more, of sizes that bring them nearer",
                                            rounds),
                        .cost = "O(N) a step",
                        .seconds = packing_again + (diagrams + rounds) * seconds_a_cell * n,
                        .bytes = bytes_a_cell * n});
  std::erase(plan.absent, cells_effect);
  plan.expected_seconds += plan.items.back().seconds;
  plan.expected_memory_bytes += plan.items.back().bytes;
  plan.scene = std::move(scene);
  return plan;
}

}  // namespace bernal
