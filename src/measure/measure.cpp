#include "bernal/measure/measure.hpp"

#include <cmath>

namespace bernal {
namespace {

SizeComparison compare_sizes_of(const Packing& packing, const SizeDistribution& asked) {
  const std::vector<double>& radii = packing.spheres.r;
  SizeComparison sizes = compare_sizes(radii, asked, packing.spheres.dimension());
  const Draw draw = packing.scene.draw.value_or(Draw::random);
  const bool cut_tail = !is_periodic(packing.domain) && !std::isfinite(asked.max());
  sizes.drawn = compare_with_drawn(radii, {asked, packing.seed, draw}, cut_tail);
  return sizes;
}

}  // namespace

Measurements measure(const Packing& packing, const SizeDistribution* asked, const MeasureOptions& options) {
  Measurements measured;
  measured.packing_fraction = packing.packing_fraction();
  std::vector<double> gaps = options.gaps;
  gaps.push_back(options.contact_gap);
  measured.by_gap = measure_contacts(packing, gaps);
  measured.contacts = measured.by_gap.back();
  measured.by_gap.pop_back();
  measured.radial = radial_distribution(packing, options.radial);
  measured.chambers = chambers(packing, options.chambers);
  measured.walls = wall_profile(packing, options.walls);
  measured.order = bond_order(packing, measured.walls ? measured.walls->regions : std::vector<Region>{});
  if (asked && !packing.spheres.empty()) measured.sizes = compare_sizes_of(packing, *asked);
  return measured;
}

}  // namespace bernal
