#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/measure/bed_profile.hpp"
#include "bernal/measure/bond_order.hpp"
#include "bernal/measure/chambers.hpp"
#include "bernal/measure/column_profile.hpp"
#include "bernal/measure/contact_list.hpp"
#include "bernal/measure/contacts.hpp"
#include "bernal/measure/local_packing.hpp"
#include "bernal/measure/pore_sizes.hpp"
#include "bernal/measure/radial_distribution.hpp"
#include "bernal/measure/size_comparison.hpp"
#include "bernal/measure/size_correlation.hpp"
#include "bernal/measure/slab.hpp"
#include "bernal/measure/structure_factor.hpp"
#include "bernal/measure/wall_profile.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// All measurements of spheres in a domain.
struct Measurements {
  double packing_fraction = 0;
  Contacts contacts;             ///< at MeasureOptions::contact_gap
  ContactSums of_contacts;       ///< at that gap
  std::vector<Contacts> by_gap;  ///< at the other gaps, in their order
  /// The smallest of these gaps at which at least half of the spheres are not rattlers. Stages leave gaps
  /// between spheres that they press together, and below those gaps the number of rattlers says nothing about
  /// the packing. Absent if no gap is large enough.
  std::optional<double> held_from;
  /// Whether the number of rattlers at this gap is meaningful.
  bool holds(const Contacts& c) const { return held_from && c.contact_gap >= *held_from; }
  /// Of the spheres in the core of `walls`, and of a bed also in its own: at the gaps of `by_gap`, and then
  /// at that of `contacts`. Absent without a core.
  std::optional<ContactsOfSome> core_contacts;

  std::optional<Slab> slab;  ///< if one is asked for
  std::optional<RadialDistribution> radial;
  std::optional<SizeCorrelation> size_correlation;
  std::optional<Chambers> chambers;
  std::optional<BedProfile> bed;
  /// Where walls, column, pores and g(r) between walls are measured: the slab, or the bed below its level.
  std::optional<LowerPart> part() const {
    if (slab) return slab->part;
    return bed ? bed->below_level() : std::nullopt;
  }
  std::optional<WallProfile> walls;
  std::optional<ColumnProfile> column;
  std::optional<BondOrder> order;
  std::optional<LocalPacking> local;
  std::optional<StructureFactor> structure;
  std::optional<PoreSizes> pores;
  std::optional<SizeComparison> sizes;
  /// What would be measured in an upright periodic box, and is not in a tilted one.
  std::vector<std::string> left_out;
};

struct MeasureOptions {
  /// Gaps that the spheres keep, see `measure_contacts_across`; contacts are measured across them.
  double gap = 0, wall_gap = 0;
  double contact_gap = 0.002;
  std::vector<double> gaps = {1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
  RadialOptions radial = {};
  SizeCorrelationOptions size_correlation = {};
  ChamberOptions chambers = {};
  BedOptions bed = {};                 ///< its gaps are ignored
  std::optional<LowerPart> slab = {};  ///< what is measured of walls, column, pores and g(r) between walls
  WallOptions walls = {};
  LocalPackingOptions local = {};
  StructureOptions structure = {};
  PoreOptions pores = {};
  /// Container of the domain in its own frame, as `Packing` holds it; made if null and needed.
  std::shared_ptr<const Container> container = {};
  Monitor monitor = {};         ///< once it stops, optional measurements are left out
  bool all_or_nothing = false;  ///< once it stops, `measure` throws Cancelled
};

/// The requested radii, to compare with: a distribution, or null for none, and how it was drawn. If the
/// packing started from given spheres, `sizes` includes them and `drawn` does not.
struct AskedRadii {
  const SizeDistribution* sizes = nullptr;
  std::uint64_t seed = 1;
  Draw draw = Draw::random;
  const SizeDistribution* drawn = nullptr;  ///< if null, the same as `sizes`
  std::span<const double> first = {};       ///< radii of the given spheres

  RadiusSequence sequence() const { return {drawn ? *drawn : *sizes, seed, draw, first}; }
};

/// Precondition: spheres of the domain's dimension. Cost: the sum of the parts. Errors: those of
/// `measure_contacts` and `measure_slab`.
Measurements measure(const Spheres<dynamic>&, const Domain&, const AskedRadii& = {},
                     const MeasureOptions& = {});

/// Volume of the spheres over that of the domain, or of one period.
double packing_fraction(const Spheres<dynamic>&, const Domain&);

/// 64-bit FNV-1a hash of the doubles of all spheres in order, coordinates then radius, little-endian, as 16
/// hexadecimal digits.
std::string hash_of(const Spheres<dynamic>&);

}  // namespace bernal
