#pragma once
#include <optional>
#include <string>

#include "soft/below_level.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

/// Porosity of beds of equal spheres in a column that is x diameters of the spheres across, far from floor
/// and top, as others fit what was measured.
///
/// Poured: 0.390 + 1.740 / (x + 1.140)², 1.5 < x < 50, mean error 1.5 % (Benyahia & O'Neill 2005).
/// Vibrated: 0.372 + 0.002 (exp(15.306 / x) - 1); loose: 0.400 + 0.010 (exp(10.686 / x) - 1), both for x of
/// at least `least_across` (Zou & Yu 1995).
double porosity_poured(double across);
double porosity_vibrated(double across);
double porosity_loose(double across);

/// Below it geometry decides, chains and rings of spheres, and no law of beds holds.
inline constexpr double least_across = 4;
/// By which measured beds of the same kind differ.
inline constexpr double scatter_of_beds = 0.02;

/// How porous a bed is.
struct BedPorosity {
  /// Of the bed up to its surface, floor and top included: that of a bed with a level top which is as dense
  /// everywhere and whose spheres have the same mean height.
  double whole;
  /// Far from both: between two levels, three mean diameters above the lowest point of the container and as
  /// far below the surface, or a quarter of the height where that is less.
  double core;
};

/// Of a bed; of a heap the core is the whole. None of a few spheres
/// on a floor, which have no porosity in (0, 1). Error: as of `Heights`. O(N).
std::optional<BedPorosity> porosity_of(const Bed&, const Heights&, const BedTop&);

/// How many diameters of its spheres a bed is across.
struct Across {
  /// In a column, its diameter; else the hydraulic diameter, 4 V / A of the volume and its upright walls,
  /// those whose normal is nearer to level than to upright. Over the mean diameter 6 V / A of the spheres.
  double diameters;
  bool is_column;  ///< a circular one, along gravity: what the laws are of
};

/// Of a container, or the part of one that the bed fills. Cost where it is no column: 32,768 questions to the
/// walls; error then some hundredths.
Across across_of(const Container&, const Vector<3>& down, double mean_diameter);
/// 6 V / A of the first `count` of the sequence.
double mean_diameter(const SpheresInBed&, std::size_t count);

/// How porous a bed is to become.
struct DensityAim {
  double porosity;
  bool of_core;       ///< rather than of the whole bed
  std::string words;  ///< what says so
};

/// None where the spheres are to lie as settling leaves them, or no law holds, which the second then says.
/// `denser`: how much denser the sizes pack than equal ones.
std::pair<std::optional<DensityAim>, std::string> aim_of(const BedTarget&, const Across&, double denser);

}  // namespace bernal
