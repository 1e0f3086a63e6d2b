#include "bernal/measure/measure.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "core/fnv.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

SizeComparison compare_sizes_of(const Spheres<dynamic>& spheres, const Domain& domain,
                                const AskedRadii& asked) {
  const bool cut_tail = has_walls(domain) && !std::isfinite(asked.sizes->max());
  const auto drawn = compare_with_drawn(spheres.r, asked.sequence(), cut_tail);
  std::vector<double> radii = spheres.r;
  if (drawn && drawn->scale != 1)
    for (double& r : radii) r /= drawn->scale;
  SizeComparison sizes = compare_sizes(radii, *asked.sizes, spheres.dimension());
  sizes.drawn = drawn;
  return sizes;
}

std::optional<double> smallest_holding_gap(const std::vector<Contacts>& by_gap, std::size_t spheres) {
  std::optional<double> smallest;
  for (const Contacts& c : by_gap)
    if (c.backbone > 0 && 2 * c.backbone >= spheres && !(smallest && *smallest <= c.contact_gap))
      smallest = c.contact_gap;
  return smallest;
}

}  // namespace

double packing_fraction(const Spheres<dynamic>& spheres, const Domain& domain) {
  const double volume = volume_of(domain);
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(spheres.dimension(), r);
  return volume > 0 ? sum / volume : 0;
}

namespace {

/// Products of larger lengths overflow.
constexpr double longest_measurable = 1e100;

void require_measurable(const Spheres<dynamic>& spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double farthest = spheres.center(i).cwiseAbs().maxCoeff(), r = spheres.r[i];
    if (!(farthest < longest_measurable && r > 1 / longest_measurable && r < longest_measurable))
      throw Error(
          ErrorCode::bad_argument,
          fmt::format("sphere {} of radius {:g}, {:g} from the origin, is beyond what can be measured, {:g} "
                      "to {:g}: check the units",
                      i, r, farthest, 1 / longest_measurable, longest_measurable));
  }
}

/// Marks for the spheres in the core; empty if there is none.
std::vector<bool> spheres_in_core(const Spheres<dynamic>& spheres, const Measurements& measured) {
  const auto& bed = measured.bed;
  if (!measured.walls || (bed && !bed->core)) return {};
  const auto is_in_bed = [&](const Vector<3>& center) {
    const double height = bed ? -bed->direction.dot(center) - bed->lowest : 0;
    return !bed || (bed->core->from <= height && height <= bed->core->to);
  };
  std::vector<bool> inside(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    inside[i] = measured.walls->regions[i] == Region::core && is_in_bed(spheres.center(i));
  return std::ranges::find(inside, true) == inside.end() ? std::vector<bool>{} : inside;
}

}  // namespace

Measurements measure(const Spheres<dynamic>& spheres, const Domain& domain, const AskedRadii& asked,
                     const MeasureOptions& options) {
  require_measurable(spheres);
  std::optional<Interruptible> interruptible;
  if (options.all_or_nothing) interruptible.emplace(options.monitor);
  Measurements measured;
  measured.packing_fraction = packing_fraction(spheres, domain);
  std::vector<double> gaps = options.gaps;
  gaps.push_back(options.contact_gap);
  const bool asked_of_box = std::holds_alternative<Box>(domain) && dimension_of(domain) != 3;
  const bool needs_container = has_walls(domain) && !asked_of_box && !spheres.empty();
  const auto container = needs_container ? local_container(domain, options.container) : nullptr;
  measured.by_gap = measure_contacts_across(options.gap, options.wall_gap, spheres, domain, gaps, container);
  measured.held_from = smallest_holding_gap(measured.by_gap, spheres.size());
  measured.contacts = measured.by_gap.back();
  measured.by_gap.pop_back();
  measured.of_contacts =
      contact_sums(spheres, domain, {options.contact_gap, options.gap, options.wall_gap, container});
  if (options.slab) require_upright(domain, "the measurement of a slab");
  if (options.slab) require_closed_walls(domain, "the measurement of a slab");
  if (options.slab) measured.slab = measure_slab(*options.slab, spheres, domain, gaps, options.gap);
  try {
    const Interruptible listening(options.monitor);
    measured.size_correlation = size_correlation(spheres, domain, options.size_correlation);
    measured.chambers = chambers(spheres, domain, options.chambers, container);
    BedOptions bed = options.bed;
    bed.gap = options.gap;
    bed.wall_gap = options.wall_gap;
    const bool upright = !is_tilted(domain);
    if (upright) measured.bed = bed_profile(spheres, domain, bed, container);
    RadialOptions radial = options.radial;
    WallOptions walls = options.walls;
    PoreOptions pores = options.pores;
    if (const auto part = measured.part()) radial.below = walls.below = pores.below = part;
    measured.radial = radial_distribution(spheres, domain, radial, container);
    measured.walls = wall_profile(spheres, domain, walls, container);
    if (const std::vector<bool> core = spheres_in_core(spheres, measured); !core.empty())
      measured.core_contacts = contacts_of_some(core, options.gap, spheres, domain, gaps);
    ColumnOptions column{.down = options.bed.direction, .slab = options.slab, .side = options.walls};
    if (measured.bed) column.level = measured.bed->level;
    if (upright) measured.column = column_profile(spheres, domain, column);
    measured.order =
        bond_order(spheres, domain, measured.walls ? measured.walls->regions : std::vector<Region>{});
    if (upright && !is_repeated_mesh(domain))
      measured.local = local_packing(spheres, domain, options.local, container);
    measured.structure = structure_factor(spheres, domain, options.structure);
    if (upright) measured.pores = pore_sizes(spheres, domain, pores, container);
    if (!upright) measured.left_out = {"local packing fractions", "pore sizes"};
    if (is_repeated_mesh(domain)) measured.left_out = {"local packing fractions", "chambers"};
  } catch (const Cancelled&) {
    if (options.all_or_nothing) throw;
  }
  if (asked.sizes && !spheres.empty()) measured.sizes = compare_sizes_of(spheres, domain, asked);
  return measured;
}

std::string hash_of(const Spheres<dynamic>& spheres) {
  Fnv1a fnv;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    for (const auto& column : spheres.x) fnv.absorb(column[i]);
    fnv.absorb(spheres.r[i]);
  }
  return fmt::format("{:016x}", fnv.hash());
}

}  // namespace bernal
