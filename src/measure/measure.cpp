#include "bernal/measure/measure.hpp"

namespace bernal {

Measurements measure(const Packing& packing, const SizeDistribution* asked, const MeasureOptions& options) {
  Measurements measured;
  measured.packing_fraction = packing.packing_fraction();
  std::vector<double> gaps = options.gaps;
  gaps.push_back(options.contact_gap);
  measured.by_gap = measure_contacts(packing, gaps);
  measured.contacts = measured.by_gap.back();
  measured.by_gap.pop_back();
  measured.radial = radial_distribution(packing, options.radial);
  if (asked && !packing.spheres.empty())
    measured.sizes = compare_sizes(packing.spheres.r, *asked, packing.spheres.dimension());
  return measured;
}

}  // namespace bernal
