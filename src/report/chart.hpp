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
  int dimension = 3;                    ///< a sphere's volume is in proportion to size^dimension
  std::string label;                    ///< of the axis, with its unit
  std::function<double(double)> asked;  ///< cumulative share by number at a size; may be empty
};

/// Bars: the share of the number and of the volume of the spheres in equal bins, and the share of the number
/// that was asked for, as inline SVG.
std::string size_histogram(const SizeHistogram&);

/// g over r in mean diameters, with the band of its error; what is higher than the axis is cut.
std::string radial_chart(const RadialDistribution&);

/// C over d in mean diameters, from the first distance at which there are pairs on, with the band of its
/// error.
std::string size_correlation_chart(const SizeCorrelation&);

/// Packing fraction over the height in that unit, with the mean height of the surface as a dashed line.
std::string bed_chart(const BedProfile&, std::string_view unit);

/// Porosity over the distance from the wall in mean diameters, with the band of its error and the mean as a
/// dashed line; empty where there are fewer than two layers of equal thickness.
std::string wall_chart(const WallProfile&);

/// Mean volume over that of all spheres, over the distance of their surfaces from the wall; empty where the
/// sizes are equal or fewer than two layers have spheres.
std::string wall_size_chart(const WallProfile&);

/// Bars: the share of the spheres by local packing fraction, within five deviations of the mean, which is a
/// dashed line; empty where all are alike to six digits.
std::string local_packing_chart(const LocalPacking&);

/// S over k in inverse mean diameters, with the band of its error; what is higher than the axis is cut.
std::string structure_chart(const StructureFactor&);

/// The density of the distances over d in mean diameters, with the band of its error.
std::string pore_chart(const PoreSizes&);

/// A line over the seconds of the run, one point a milestone, as inline SVG. Where a stage begins
/// its name stands, if there is room for it. Precondition: at least two milestones.
std::string history_chart(std::span<const Milestone> history, double Milestone::*value,
                          std::string_view label);

/// The same for the largest overlap, in decades; empty where fewer than two milestones have any.
std::string overlap_chart(std::span<const Milestone> history);

}  // namespace bernal
