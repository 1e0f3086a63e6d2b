#pragma once
#include <optional>
#include <string>

#include "soft/below_level.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// Porosity of beds of equal spheres in a column x sphere diameters across, far from floor and top, by
/// published fits to measurements.
///
/// Poured: 0.390 + 1.740 / (x + 1.140)², 1.5 < x < 50, mean error 1.5 % (Benyahia & O'Neill 2005). Vibrated:
/// 0.372 + 0.002 (exp(15.306 / x) - 1); loose: 0.400 + 0.010 (exp(10.686 / x) - 1), both for x of at least
/// `least_across` (Zou & Yu 1995).
double porosity_poured(double across);
double porosity_vibrated(double across);
double porosity_loose(double across);

/// In narrower columns spheres form chains and rings, and these laws do not hold.
inline constexpr double least_across = 4;
/// The difference between measured beds of the same kind.
inline constexpr double scatter_of_beds = 0.02;

/// The porosity of a bed.
struct BedPorosity {
  /// Up to the surface, floor and top included: that of an equally dense bed with a level top whose spheres
  /// have the same mean height.
  double whole;
  /// Far from floor and top: between two levels, three mean diameters above the lowest point of the container
  /// and three below the surface, or a quarter of the height if that is less.
  double core;
};

/// The porosity of the bed of that work; the core of a heap is the whole. Nothing for a few spheres on a
/// floor, which have no porosity in (0, 1). Error: that of `Heights`. O(N).
std::optional<BedPorosity> porosity_of(const Bed&, const Heights&, const BedTop&);

/// The width of a bed in diameters of its spheres.
struct Across {
  /// The diameter of a circular column. Else the hydraulic diameter 4 V / A, from the volume and the area of
  /// the upright walls, those whose normal is nearer to level than to upright. In mean diameters 6 V / A of
  /// the spheres.
  double diameters;
  bool is_column;  ///< whether it is a circular column along gravity, as in the laws
};

/// The width of a container, or of the part of one that the bed fills. Cost if it is no column: 32,768
/// questions to the walls; the error is then some hundredths.
Across across_of(const Container&, const Vector<3>& down, double mean_diameter);
/// 6 V / A of the first `count` spheres of the sequence.
double mean_diameter(const SpheresInBed&, std::size_t count);

/// The porosity that a bed is to have.
struct DensityAim {
  double porosity;
  bool of_core;       ///< whether it is that of the core, and not of the whole bed
  std::string words;  ///< the law or the request that it follows from
};

/// The aim, or nothing if the spheres are to lie as settling leaves them or no law holds; the second then
/// says why. `denser` is the factor by which the sizes pack denser than equal ones.
std::pair<std::optional<DensityAim>, std::string> aim_of(const BedTarget&, const Across&, double denser);

}  // namespace bernal
