#pragma once
#include <span>
#include <string>
#include <string_view>

#include "bernal/run/packing.hpp"

namespace bernal {

/// Bars: the share of the number and of the volume of spheres in equal bins of `sizes`, as inline SVG.
/// `sizes` are radii or diameters; `label` names the axis with its unit. Precondition: not empty, not all
/// equal.
std::string size_histogram(std::span<const double> sizes, std::string_view label);

/// A line over the seconds of the run, one point a milestone, as inline SVG. Where a stage begins
/// its name stands, if there is room for it. Precondition: at least two milestones.
std::string history_chart(std::span<const Milestone> history, double Milestone::*value,
                          std::string_view label);

}  // namespace bernal
