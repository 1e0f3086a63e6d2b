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
#include "bernal/measure/contacts.hpp"
#include "bernal/measure/local_packing.hpp"
#include "bernal/measure/pore_sizes.hpp"
#include "bernal/measure/radial_distribution.hpp"
#include "bernal/measure/size_comparison.hpp"
#include "bernal/measure/size_correlation.hpp"
#include "bernal/measure/structure_factor.hpp"
#include "bernal/measure/wall_profile.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// What can be said of spheres in a domain.
struct Measurements {
  double packing_fraction = 0;
  Contacts contacts;             ///< at MeasureOptions::contact_gap
  std::vector<Contacts> by_gap;  ///< at the others, in their order
  /// The smallest of these gaps at which half of the spheres or more are no rattlers. A stage leaves gaps of
  /// its own between spheres that it presses together, and below them a count of rattlers says nothing of the
  /// packing. Absent where no gap is large enough.
  std::optional<double> held_from;
  /// Whether a count of rattlers at the gap of these contacts says something.
  bool holds(const Contacts& c) const { return held_from && c.contact_gap >= *held_from; }
  std::optional<RadialDistribution> radial;
  std::optional<SizeCorrelation> size_correlation;
  std::optional<Chambers> chambers;
  std::optional<BedProfile> bed;  ///< below whose level walls and pores are measured, if it has one
  std::optional<WallProfile> walls;
  std::optional<BondOrder> order;
  std::optional<LocalPacking> local;
  std::optional<StructureFactor> structure;
  std::optional<PoreSizes> pores;
  std::optional<SizeComparison> sizes;
};

struct MeasureOptions {
  /// That the spheres keep, see `measure_contacts_across`; the contacts are measured with these.
  double gap = 0, wall_gap = 0;
  double contact_gap = 0.002;
  std::vector<double> gaps = {1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2};
  RadialOptions radial = {};
  SizeCorrelationOptions size_correlation = {};
  ChamberOptions chambers = {};
  BedOptions bed = {};  ///< without its gaps
  WallOptions walls = {};
  LocalPackingOptions local = {};
  StructureOptions structure = {};
  PoreOptions pores = {};
  /// Of the domain in its own frame, see `local_container`; made where it is null and needed.
  std::shared_ptr<const Container> container = {};
  Monitor monitor = {};         ///< once it says stop, what may be absent is
  bool all_or_nothing = false;  ///< once it says stop, `measure` throws Cancelled
};

/// What the radii are held against: a distribution, or null for nothing, and how it was drawn from. Where
/// spheres of a start came before those drawn, `sizes` are those of all, and what was `drawn` is another.
struct AskedRadii {
  const SizeDistribution* sizes = nullptr;
  std::uint64_t seed = 1;
  Draw draw = Draw::random;
  const SizeDistribution* drawn = nullptr;  ///< null: `sizes`
  std::span<const double> first = {};       ///< radii of the start

  RadiusSequence sequence() const { return {drawn ? *drawn : *sizes, seed, draw, first}; }
};

/// Precondition: spheres of the domain's dimension. Cost: that of the parts.
Measurements measure(const Spheres<dynamic>&, const Domain&, const AskedRadii& = {},
                     const MeasureOptions& = {});

/// Volume of the spheres over that of the domain, or of one period.
double packing_fraction(const Spheres<dynamic>&, const Domain&);

/// 64-bit FNV-1a of the doubles of all spheres in order, the coordinates and r of each, little-endian; 16
/// hexadecimal digits.
std::string hash_of(const Spheres<dynamic>&);

}  // namespace bernal
