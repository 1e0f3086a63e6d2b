#include "bernal/measure/bed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/cad/mesh_container.hpp"
#include "core/parallel.hpp"
#include "domain/ball_below.hpp"
#include "domain/places.hpp"
#include "domain/volume_below.hpp"
#include "measure/bed_surface.hpp"
#include "measure/even_points.hpp"
#include "measure/localised.hpp"
#include "measure/slices.hpp"
#include "measure/volume_in.hpp"

namespace bernal {
namespace {

constexpr double width_of_cells = 0.5;  // in mean diameters
constexpr double least_empty = 0.02;    // of a container that counts as not full
constexpr double most_hanging = 0.5;
constexpr double low_share = 0.05;  // of the surface, below the level
constexpr double rounding_of_layers = 1e-6;
constexpr std::size_t points_of_surface = 1 << 15;

/// The spheres in the container's frame, with heights against gravity.
struct BedInFrame {
  const Spheres<3>& spheres;
  const Container& container;
  const VolumeBelow& below;
  Vector<3> down;
  double diameter;

  double height(std::size_t i) const { return -down.dot(spheres.center(i)); }
  double highest() const {
    double highest = below.lowest();
    for (std::size_t i = 0; i < spheres.size(); ++i) highest = std::max(highest, height(i) + spheres.r[i]);
    return highest;
  }
  double filled() const { return filled_below(below.highest()); }
  double filled_below(double level) const {
    double sum = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i)
      sum += ball_below(container.dimension(), spheres.r[i], level - height(i));
    return sum;
  }
  bool is_full() const {
    const double top = highest() + diameter, whole = below(below.highest());
    return top >= below.highest() || whole - below(top) < least_empty * whole;
  }
};

struct MeanSurface {
  double value, deviation, share;
};

/// Over the cells that are not bare; `share` is their share of all.
MeanSurface mean_surface(const std::vector<BedSurface::Cell>& cells) {
  double all = 0, covered = 0, sum = 0, squares = 0;
  for (const auto& [height, share] : cells) {
    all += share;
    if (height == BedSurface::bare) continue;
    covered += share;
    sum += share * height;
  }
  if (!(covered > 0)) return {0, 0, 0};
  const double mean = sum / covered;
  for (const auto& [height, share] : cells)
    if (height != BedSurface::bare) squares += share * (height - mean) * (height - mean);
  return {mean, std::sqrt(squares / covered), covered / all};
}

/// The height that this share of the covered cells is below.
double quantile_of(std::vector<BedSurface::Cell> cells, double share) {
  std::erase_if(cells, [](const auto& c) { return c.height == BedSurface::bare || !(c.share > 0); });
  std::ranges::sort(cells, {}, &BedSurface::Cell::height);
  double all = 0, sum = 0;
  for (const auto& c : cells) all += c.share;
  for (const auto& c : cells)
    if ((sum += c.share) >= share * all) return c.height;
  return cells.back().height;
}

struct Volume {
  double value, error;
};

/// The container's volume below the surface: exact below its mean height, and sampled for the difference.
Volume below_surface(const BedInFrame& all, const BedSurface& surface, double mean) {
  const double highest = all.highest();
  const Bounds<3> bounds = LowerPart{all.down, highest}.cut(all.container.bounds());
  const std::vector<Vector<3>> points = points_inside(
      all.container, points_of_surface, 1,
      [&](std::size_t k) { return Vector<3>(bounds.lower + bounds.size().cwiseProduct(even_point(k))); });
  double looked = 0, more = 0, less = 0;
  for (const Vector<3>& p : points) {
    const double height = -all.down.dot(p);
    if (height > highest) continue;
    ++looked;
    const bool below = height <= surface.height_over(p), below_mean = height <= mean;
    more += below && !below_mean;
    less += below_mean && !below;
  }
  const double one = looked > 0 ? all.below(highest) / looked : 0;
  return {all.below(mean) + one * (more - less), one * std::sqrt(more + less)};
}

std::vector<BedProfile::Layer> layers_of(const BedInFrame& all, const BedOptions& options) {
  const double lowest = all.below.lowest(), deep = all.highest() - lowest;
  const double wanted = std::ceil(deep / (options.layer * all.diameter) - rounding_of_layers);
  const auto n = static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(options.most_layers)));
  const double thickness = deep / static_cast<double>(n);
  const std::vector<double> filled =
      filled_slices(all.spheres, all.container.dimension(), -all.down, lowest, thickness, n);
  std::vector<double> below(n + 1, 0);
  parallel_for(
      n, [&](std::size_t k) { below[k + 1] = all.below(lowest + static_cast<double>(k + 1) * thickness); });
  std::vector<BedProfile::Layer> layers(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double room = below[k + 1] - below[k];
    layers[k] = {static_cast<double>(k) * thickness, static_cast<double>(k + 1) * thickness,
                 room > 0 ? filled[k] / room : 0};
  }
  return layers;
}

std::optional<BedProfile::Core> core_of(const BedInFrame& all, double level) {
  const double margin = BedProfile::core_depth * all.diameter;
  const double from = all.below.lowest() + margin, to = level - margin;
  if (to - from < all.diameter) return {};
  return BedProfile::Core{
      from, to, 1 - (all.filled_below(to) - all.filled_below(from)) / (all.below(to) - all.below(from))};
}

void scale(BedProfile& profile, double unit) {
  for (double* length : {&profile.mean_diameter, &profile.height, &profile.highest, &profile.roughness})
    *length *= unit;
  if (profile.level) *profile.level *= unit;
  if (auto& core = profile.core) {
    core->from *= unit;
    core->to *= unit;
  }
  for (auto& layer : profile.layers) {
    layer.from *= unit;
    layer.to *= unit;
  }
}

}  // namespace

std::optional<LowerPart> BedProfile::below_level() const {
  if (!level) return {};
  return LowerPart{direction, lowest + *level};
}

std::optional<BedProfile> bed_profile(const Spheres<dynamic>& packed, const Domain& domain,
                                      const BedOptions& options,
                                      const std::shared_ptr<const Container>& made) {
  const int dimension = dimension_of(domain);
  if (packed.empty() || dimension < 2 || dimension > 3) return {};
  const Vector<3> down = options.direction.value_or(-Vector<3>::Unit(dimension - 1)).normalized();
  if (!has_ends_along(domain, down)) return {};
  const Frame frame = frame_of(domain);
  const std::shared_ptr<const Container> container = local_container(domain, made);
  const Spheres<3> spheres = localised(packed, frame);
  const VolumeBelow below(to_local(domain, frame), down);
  const double diameter =
      2 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
  const BedInFrame all{spheres, *container, below, down, diameter};
  const bool full = all.is_full();
  if (full && !options.is_bed) return {};

  BedProfile profile;
  profile.direction = down;
  profile.mean_diameter = diameter;
  profile.rest =
      measure_rest(packed, domain, down,
                   {.gap = options.gap, .wall_gap = options.wall_gap, .friction = options.friction}, made);
  if (!options.is_bed &&
      static_cast<double>(profile.rest.hanging) > most_hanging * static_cast<double>(packed.size()))
    return {};
  const double floor = below.lowest();
  const BedSurface surface(spheres, *container, down, width_of_cells * diameter);
  const std::vector<BedSurface::Cell> cells = surface.cells(*container, floor);
  const MeanSurface mean = mean_surface(cells);
  if (!(mean.share > 0)) return {};
  const Volume bed = below_surface(all, surface, mean.value);
  const double filled = all.filled();
  profile.height = mean.value - floor;
  profile.roughness = mean.deviation;
  profile.covered = mean.share;
  profile.highest = all.highest() - floor;
  profile.porosity = 1 - filled / bed.value;
  profile.porosity_error = filled / bed.value * bed.error / bed.value;
  profile.layers = layers_of(all, options);
  const double low = quantile_of(cells, low_share);
  if (mean.share >= BedProfile::well_covered) {
    profile.core = core_of(all, low);
    if (profile.core) {
      profile.core->from -= floor;
      profile.core->to -= floor;
    }
    if (!full && low - floor >= diameter) profile.level = low - floor;
  }
  scale(profile, frame.scale);
  profile.lowest = frame.scale * floor - down.dot(frame.origin);
  return profile;
}

}  // namespace bernal
