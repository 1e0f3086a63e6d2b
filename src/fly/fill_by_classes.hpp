#pragma once
#include "soft/fill_by_relaxation.hpp"

namespace bernal {

/// As `fill_by_relaxation`, for spheres of widely differing sizes: the largest come first, at places where
/// they fit between those that are there. What finds no place that way is left to `fill_by_relaxation`.
/// Spheres that have places already keep them for a start if they do not overlap.
///
/// A random place that overlaps is pushed to where it does not, a dozen times at most; between rounds of such
/// trials the spheres of the class move at random. Cost: about 1 µs a trial in three dimensions.
StageEnd fill_by_classes(SpheresInBox& in_box, Reporter& report, const FillOptions& options);

}  // namespace bernal
