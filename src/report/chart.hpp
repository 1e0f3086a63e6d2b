#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "bernal/measure/bed_profile.hpp"
#include "bernal/measure/local_packing.hpp"
#include "bernal/measure/pore_sizes.hpp"
#include "bernal/measure/radial_distribution.hpp"
#include "bernal/measure/size_correlation.hpp"
#include "bernal/measure/structure_factor.hpp"
#include "bernal/measure/wall_profile.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

struct SizeHistogram {
  std::span<const double> sizes;        ///< radii or diameters; not empty, not all equal
  int dimension = 3;                    ///< volume is proportional to size^dimension
  std::string label;                    ///< of the axis, with its unit
  std::function<double(double)> asked;  ///< requested cumulative share by number; may be empty
};

/// Bars with the shares of number and volume of the spheres in equal bins, and the requested share of the
/// number, as inline SVG.
std::string size_histogram(const SizeHistogram&);

/// g over r in mean diameters, with its error band, clipped at the top of the axis.
std::string radial_chart(const RadialDistribution&);

/// C over d in mean diameters, from the first distance with pairs, with its error band.
std::string size_correlation_chart(const SizeCorrelation&);

/// Packing fraction over the height in the given unit, with the mean height of the surface as a dashed line.
std::string bed_chart(const BedProfile&, std::string_view unit);

/// Porosity over the distance from the wall in mean diameters, with its error band and the mean as a dashed
/// line; empty for fewer than two layers of equal thickness.
std::string wall_chart(const WallProfile&);

/// Mean volume over that of all spheres, over the distance of their surfaces from the wall; empty if the
/// sizes are equal or fewer than two layers have spheres.
std::string wall_size_chart(const WallProfile&);

/// Bars with the share of the spheres by local packing fraction, within five deviations of the mean, a dashed
/// line; empty if all are equal to six digits.
std::string local_packing_chart(const LocalPacking&);

/// S over k in inverse mean diameters, with its error band, clipped at the top of the axis.
std::string structure_chart(const StructureFactor&);

/// The density of the distances over d in mean diameters, with its error band.
std::string pore_chart(const PoreSizes&);

/// A line over the seconds of the run, one point a milestone, as inline SVG, with the names of stages where
/// they begin, if they fit. Precondition: at least two milestones.
std::string history_chart(std::span<const Milestone> history, double Milestone::*value,
                          std::string_view label);

/// The same for the largest overlap, on a logarithmic axis; empty if fewer than two milestones have any.
std::string overlap_chart(std::span<const Milestone> history);

}  // namespace bernal
