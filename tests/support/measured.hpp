#pragma once
#include <optional>
#include <span>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

// Measurements of a packing that the tests have as a whole.
namespace bernal {

inline Contacts measure_contacts(const Packing& packing, double contact_gap = 0.002) {
  return measure_contacts(packing.spheres, packing.domain, contact_gap);
}
inline std::vector<Contacts> measure_contacts(const Packing& packing, std::span<const double> contact_gaps) {
  return measure_contacts(packing.spheres, packing.domain, contact_gaps);
}
inline std::optional<BondOrder> bond_order(const Packing& packing, std::span<const Region> regions = {}) {
  return bond_order(packing.spheres, packing.domain, regions);
}
inline std::optional<Chambers> chambers(const Packing& packing, const ChamberOptions& options = {}) {
  return chambers(packing.spheres, packing.domain, options);
}
inline std::optional<RadialDistribution> radial_distribution(const Packing& packing,
                                                             const RadialOptions& options = {}) {
  return radial_distribution(packing.spheres, packing.domain, options);
}
inline std::optional<WallProfile> wall_profile(const Packing& packing, const WallOptions& options = {}) {
  return wall_profile(packing.spheres, packing.domain, options);
}

}  // namespace bernal
