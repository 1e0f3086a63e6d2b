#include "plan/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/predict/predict.hpp"
#include "core/close_packing.hpp"
#include "domain/places.hpp"
#include "domain/volume_below.hpp"
#include "geometry/openings.hpp"
#include "plan/fitting.hpp"
#include "plan/stages.hpp"
#include "sizes/volume_carriers.hpp"
#include "soft/below_level.hpp"

namespace bernal {
namespace {

/// What compression reaches of the random close packing fraction of the same sizes, away from walls, and by
/// how much a wall lowers it: measured, see `expected_packing_fraction`.
constexpr double share_of_close_packing = 0.966;
constexpr double wall_deficit = 0.33;
/// The same of discs, of which random close packing has 0.84 of the area: from fills of squares with x from
/// 0.1 to 0.44, equal and lognormal, of 79 to 1,603 discs, all of which met this within 0.017.
constexpr double share_of_close_packing_flat = 0.953;
constexpr double wall_deficit_flat = 0.165;
/// The same for relaxation, and for growth, which met it or went up to 0.02 beyond in containers thicker than
/// two spheres: from what it reached in boxes, cylinders, a sphere, a hopper and four CAD parts. This is what
/// relaxation begins with where it may fill a container, and less than it can be made to reach: where 0.04
/// more was asked of 70 to 120,000 spheres with x from 0.2 to 1.4, it came to 0.004 to 0.017 more in
/// cylinders, a sphere and CAD parts (but 0.013 less in the sphere with x = 1.2 and 0.03 less in a part with
/// x = 1), and to 0.01 to 0.035 more between flat walls, along which spheres order themselves the more the
/// longer it takes. To begin 0.008 higher takes four times as long (300,000 lognormal spheres in two parts).
/// Of discs the same holds: 38 to 42,000 in squares, a silo with a wedge and an L came to what is expected,
/// and where as many as could be placed were asked for to 0.02 more of two sizes 1:1.4, 0.03 of lognormal and
/// 0.04 to 0.06 of equal ones, which crystallise.
constexpr double share_relaxed = 0.975, wall_deficit_relaxed = 0.115;
/// And where only a part of the container is wide enough for the larger spheres.
constexpr double share_in_thin_parts = 0.80;
/// Classes of equal volume that the sizes are looked at in, and the quantiles that these are made from.
constexpr std::size_t volume_classes = 5, quantiles = 500;
constexpr std::size_t sample_points = 5000;
/// Of the largest spheres across a container: with fewer it is a matter of chance how they fit.
constexpr double chance_below = 3;
/// How much of itself a covering sphere may lack, as the wall's nearest point is known to rounding only.
constexpr double slack = 0.02;
constexpr int most_moves = 8;
/// The largest of 10,000 spheres.
constexpr double quantile_of_largest = 1 - 1e-4;
/// What relaxation reaches of rods in line, which nothing stops from filling it.
constexpr double in_line = 0.99;

/// Whether a sphere of radius r that lies inside covers p: its centre is moved from p off one wall after the
/// other, in a corner off three.
bool is_coverable(const Container& container, const Vector<3>& p, double clearance, double r,
                  std::vector<NearFacet>& facets) {
  Vector<3> center = p;
  for (int k = 0; k < most_moves && clearance < (1 - slack) * r; ++k) {
    facets.clear();
    container.facets_near(center, 1.0001 * clearance + 1e-6 * r, facets);
    if (facets.empty()) return false;
    const Vector<3> wall = closest_point(facets.front().facet, center);
    const double d = (center - wall).norm();
    if (!(d > 0)) return false;
    center = wall + r / d * (center - wall);
    clearance = container.clearance_within(center, r);
  }
  return clearance >= (1 - slack) * r && (center - p).norm() <= r;
}

/// The middle radii of classes of equal volume, ascending; one if all radii are equal.
std::vector<double> radii_by_volume(const SizeDistribution& radii, int dimension) {
  if (radii.min() == radii.max()) return {radii.min()};
  std::vector<double> all;
  double volume = 0;
  for (std::size_t k = 0; k < quantiles; ++k) {
    all.push_back(radii.quantile((static_cast<double>(k) + 0.5) / quantiles));
    volume += std::pow(all.back(), dimension);
  }
  std::vector<double> middle;
  double sum = 0;
  for (const double r : all) {
    sum += std::pow(r, dimension);
    while (middle.size() < volume_classes &&
           sum > volume * (static_cast<double>(middle.size()) + 0.5) / volume_classes)
      middle.push_back(r);
  }
  return middle;
}

/// A part of a domain that spheres are to fill: its walls, and the surface of the bed.
struct Part {
  std::shared_ptr<const Container> container;  // in the domain's frame
  double volume, area;                         // in the scene's unit
};

/// The area of a mesh below a level, floor and walls and what stands in it.
double area_below(const Mesh& mesh, const Vector<3>& up, double level) {
  double area = 0;
  std::vector<Vector<3>> kept;
  for (const auto& triangle : triangles_of_walls(mesh)) {
    kept.clear();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<3>&a = mesh.vertices[triangle[k]], &b = mesh.vertices[triangle[(k + 1) % 3]];
      const double above_a = up.dot(a) - level, above_b = up.dot(b) - level;
      if (above_a <= 0) kept.push_back(a);
      if ((above_a < 0 && above_b > 0) || (above_a > 0 && above_b < 0))
        kept.push_back(a + above_a / (above_a - above_b) * (b - a));
    }
    for (std::size_t k = 2; k < kept.size(); ++k)
      area += 0.5 * (kept[k - 1] - kept[0]).cross(kept[k] - kept[0]).norm();
  }
  return area;
}

/// The whole domain; of a bed of given height what is below its surface. What walls that has is counted in a
/// mesh, and in other vessels, and below a heap, as if they were as wide everywhere.
Part part_to_fill(const Scene& scene, const Domain& shape, const std::shared_ptr<const Container>& made) {
  Part part{local_container(shape, made), volume_of(shape), area_of(shape)};
  const BedTarget& bed = scene.target.bed;
  if (!(bed.above_ground > 0)) return part;
  const double scale = frame_of(shape).scale;
  const Vector<3> down = down_in(scene);
  const BedTop top(bed, *part.container, down);
  const VolumeBelow volume_below(to_local(shape, frame_of(shape)), down);
  const double above_ground = bed.above_ground / scale, level = volume_below.lowest() + above_ground;
  const double whole = part.container->volume();
  const auto* mesh = top.is_level() ? std::get_if<Mesh>(&shape) : nullptr;
  const double below =
      mesh ? volume_below(level) : Heights(*part.container, top, volume_below.lowest()).volume_below(level);
  if (!(below > 0 && below < whole)) return part;
  const double share = below / whole, height = down.cwiseAbs().dot(part.container->bounds().size()) * scale;
  if (mesh) {
    const double step = 1e-3 * above_ground;
    const double surface = (volume_below(level + step) - volume_below(level - step)) / (2 * step);
    const double ground = VolumeBelow(shape, down).lowest();
    part.area = area_below(*mesh, -down, ground + bed.above_ground) + scale * scale * surface;
  } else {
    const double section = part.volume / height;
    part.area = 2 * section + share * std::max(0.0, part.area - 2 * section);
  }
  part.container = cut_by_planes(part.container, top.planes(level), below);
  part.volume *= share;
  return part;
}

/// x = A d / V, for a wall of area A, a volume V and the mean diameter d that counts by surface; in two
/// dimensions for its length, an area and the diameter that counts by circumference.
double wall_share(double area, double volume, int dimension, const SizeDistribution& radii) {
  return 2 * radii.moment(dimension) / radii.moment(dimension - 1) * area / volume;
}
double wall_share(const Domain& shape, const SizeDistribution& radii) {
  return wall_share(area_of(shape), volume_of(shape), dimension_of(shape), radii);
}

/// Random close packing, less a deficit at the wall, of what spheres of each size can cover. And the larger
/// ones have no more room than what they can cover, which in thin parts is less than their share.
double reached_by_relaxation(const Domain& shape, const SizeDistribution& radii, const Part& part) {
  const Frame frame = frame_of(shape);
  const int dimension = dimension_of(shape);
  const std::vector<double> by_volume = radii_by_volume(radii, dimension);
  const auto n = static_cast<double>(by_volume.size());
  double mean = 0, tightest = 2;
  for (std::size_t k = 0; k < by_volume.size(); ++k) {
    const double share = coverable_share(*part.container, by_volume[k] / frame.scale);
    mean += share / n;
    // What the larger ones can cover, over their share.
    if (k > 0) tightest = std::min(tightest, share_in_thin_parts * share * n / (n - static_cast<double>(k)));
  }
  const double wall = wall_share(part.area, part.volume, dimension, radii);
  return close_packing_fraction(radii, dimension) * share_relaxed * std::min(mean, tightest) *
         std::max(0.1, 1 - wall_deficit_relaxed * wall);
}

/// See `error_between_walls`.
double error_at(double wall_share) {
  constexpr double share = 0.12, power = 1.5;
  return std::min(1.0, share * std::pow(std::max(0.0, wall_share - 1), power));
}

bool reaches(const Scene& scene, Reaches what) { return any_stage(scene, &StageTraits::reaches, what); }

}  // namespace

void set_height_of_bed(Plan& plan) {
  BedTarget& bed = plan.scene.target.bed;
  if (bed.asks_for_density() && plan.scene.asks_for_gaps())
    throw Error(ErrorCode::bad_scene,
                "the density of a bed in [spheres] is that of spheres which touch: leave it out, or the gaps",
                plan.scene.target.where);
  if (!bed.gives_height()) return;
  bed.above_ground = bed.height ? *bed.height : *bed.layers * 2 * plan.radii->moment(1);
  const auto refuse = [&](const std::string& why) {
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("a bed that is {:.4g} {} high {}", bed.above_ground, name_of(plan.scene.unit), why),
        plan.scene.locations.of(bed.height ? "height" : "bed_layers"));
  };
  const double most = down_in(plan.scene).cwiseAbs().dot(bounds_of(plan.domain).size());
  if (bed.above_ground > (1 + 1e-9) * most)
    refuse(fmt::format("is higher than the container, {:.4g}: leave \"{}\" out to fill it to the brim", most,
                       bed.height ? "height" : "bed_layers"));
  const double most_radius = plan.radii->max();
  const double largest = std::isfinite(most_radius) ? most_radius : plan.radii->quantile(quantile_of_largest);
  const double least = 2 * largest + plan.scene.wall_gap;
  if (bed.above_ground < (1 - 1e-9) * least)
    refuse(fmt::format(
        "has no room for the largest spheres, which need {:.4g}: give the sizes a \"max\", or make "
        "it higher",
        least));
}

Plan::ExpectedBed expected_bed(const Plan& plan) {
  const auto container = local_container(plan.domain, plan.container);
  const double scale = frame_of(plan.domain).scale;
  const BedTarget& bed = plan.scene.target.bed;
  const Vector<3> down = down_in(plan.scene);
  const Heights heights(*container, BedTop(bed, *container, down),
                        VolumeBelow(to_local(plan.domain, frame_of(plan.domain)), down).lowest());
  double solid = plan.attainable_packing_fraction, height = bed.above_ground / scale;
  if (height > 0) {
    solid *= container->volume() / heights.volume_below(heights.ground() + height);
  } else {
    const double filled = plan.expected_packing_fraction / solid;
    height = heights.holding(std::min(1.0, filled) * container->volume()) - heights.ground();
  }
  if (bed.porosity) solid = 1 - *bed.porosity;
  return {1 - solid, height * scale};
}

double coverable_share(const Container& container, double r) {
  // The additive recurrence of the plastic number's relative in three dimensions (Roberts 2018).
  constexpr double step[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  const Bounds<3> bounds = container.bounds();
  const auto even_point = [&](std::size_t n) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) {
      const double u = 0.5 + step[k] * static_cast<double>(n + 1);
      p[k] = bounds.lower[k] + (u - std::floor(u)) * bounds.size()[k];
    }
    return p;
  };
  std::size_t covered = 0;
  std::vector<NearFacet> facets;
  const std::vector<Vector<3>> inside = points_inside(container, sample_points, 1, even_point);
  if (inside.empty()) refuse_thin_container();
  for (const Vector<3>& p : inside)
    covered += is_coverable(container, p, container.clearance_within(p, r), r, facets);
  return static_cast<double>(covered) / static_cast<double>(inside.size());
}

double reached_between_walls(const Scene& scene, const Box& box, const SizeDistribution& radii) {
  return reached_by_relaxation(box, radii, part_to_fill(scene, box, {}));
}

double close_packing_fraction(const SizeDistribution& radii, int dimension) {
  if (dimension == 1) return in_line;
  return dimension == 3 ? predict_packing_fraction(radii).phi : random_close_packing[dimension - 1];
}

double gain_of_stages(const Scene& scene, const Domain& shape, const SizeDistribution& radii) {
  double gain = 0;  // no less than what one of them makes by itself
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  const bool has_walls = box && !box->walls.empty();
  const auto around = [&](bool in_bed) -> WallsAround {
    if (!in_bed) return {.has_walls = has_walls};
    const int dimension = dimension_of(shape);
    return {.has_walls = true,
            .in_bed = true,
            .is_round = !std::holds_alternative<Box>(shape),
            .volume_in_spheres = volume_of(shape) / (ball_volume(dimension, 1) * radii.moment(dimension))};
  };
  for (const Stage& stage : scene.stages) {
    const StageEntry& entry = entry_of(stage);
    gain = std::max(gain, entry.gain ? entry.gain(entry.table.options(stage), radii, scene.dimension(),
                                                  around(entry.table.traits.stands_in_bed(scene)))
                                     : 1);
  }
  return gain > 0 ? gain : 1;
}

double reached_by_last(const Scene& scene) {
  double reached = 1;
  for (const Stage& stage : scene.stages)
    if (const StageEntry& entry = entry_of(stage); !entry.table.traits.only_moves)
      reached = entry.reached ? entry.reached(entry.table.options(stage)) : 1;
  return reached;
}

double error_of_expectation(const Scene& scene, const Domain& shape, const SizeDistribution& radii,
                            double expected) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (!any_in_bed(scene) && (!box || box->walls.empty())) return 0.01;
  return std::max(reaches(scene, Reaches::close_packing) ? 0.016 : 0.03,
                  error_between_walls(shape, radii) * expected);
}

double stated_error(const Scene& scene, const Domain& shape, const SizeDistribution& radii, double expected) {
  return std::max(error_of_expectation(scene, shape, radii, expected),
                  error_of_few_large(shape, radii) * expected);
}

double largest_across(const Domain& shape, const SizeDistribution& radii) {
  const int dimension = dimension_of(shape);
  if (dimension < 2 || dimension > 3 || !has_walls(shape)) return std::numeric_limits<double>::infinity();
  const auto* box = std::get_if<Box>(&shape);
  int axes = box ? 0 : dimension;
  for (int k = 0; box && k < dimension; ++k) axes += box->has_wall(k);
  const double diameter = 2 * volume_carriers(radii, dimension).radius;
  return 2 * axes * volume_of(shape) / area_of(shape) / diameter;
}

double error_of_few_large(const Domain& shape, const SizeDistribution& radii) {
  const double across = largest_across(shape, radii);
  if (!(across < chance_below)) return 0;
  return error_at(2 * dimension_of(shape) / across);
}

double error_between_walls(const Domain& shape, const SizeDistribution& radii) {
  const int dimension = dimension_of(shape);
  if (dimension < 2 || dimension > 3 || !has_walls(shape)) return 0;
  return error_at(wall_share(shape, radii));
}

/// Compression leaves a share of close packing that falls with x = A d / V, for a wall of area A, a volume V
/// and the surface-weighted mean diameter d. Fitted to fills with x from 0.18 (Han's cylinder) to 1.6 (a part
/// only two spheres thick), all of them met within 0.03.
double expected_packing_fraction(const Scene& scene, const Domain& shape, const SizeDistribution& radii,
                                 const std::shared_ptr<const Container>& made) {
  if (reaches(scene, Reaches::close_packing))
    return gain_of_stages(scene, shape, radii) *
           reached_by_relaxation(shape, radii, part_to_fill(scene, shape, made));
  if (!reaches(scene, Reaches::settled)) {
    const int dimension = dimension_of(shape);
    const double largest = radii.quantile(quantile_of_largest);
    const Part part = part_to_fill(scene, shape, made);
    const EmptyBed bed{.dimension = dimension,
                       .relaxed = reached_by_relaxation(shape, radii, part),
                       .wall_share = wall_share(part.area, part.volume, dimension, radii),
                       .largest = largest,
                       .evenness = std::min(1.0, radii.moment(dimension) / std::pow(largest, dimension)),
                       .share = part.volume / volume_of(shape)};
    double fraction = 0;
    for (const Stage& stage : scene.stages)
      if (const StageEntry& entry = entry_of(stage); entry.full) {
        const void* options = entry.table.options(stage);
        fraction = std::max(fraction, std::min(entry.reached(options), entry.full(options, bed)));
      }
    return fraction;
  }
  const bool flat = dimension_of(shape) == 2;
  return (flat ? share_of_close_packing_flat : share_of_close_packing) *
         close_packing_fraction(radii, dimension_of(shape)) *
         std::max(0.1, 1 - (flat ? wall_deficit_flat : wall_deficit) * wall_share(shape, radii));
}

}  // namespace bernal
