#pragma once
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Limits of filling a box that does not take all spheres.
struct FillOptions {
  /// The most sweeps over all spheres.
  double sweeps = 20000;
};

/// Whether each sphere by itself fits into the box `Task::target_edges`: none overlaps its own image by more
/// than is allowed. Precondition: `Task::target_edges` is set.
bool fits_box(const SpheresInBox& in_box);

/// Puts all spheres, with the radii that they have, into the box `Task::target_edges`, in 1 to 8 dimensions,
/// by pushing overlapping spheres apart. They start where they are, relative to the box; without places they
/// start at random, in one dimension in line. If nothing overlaps, they stay.
///
/// If it has `converged`, all spheres are there and no two images overlap by more than
/// `Task::allowed_overlap`, proven in double precision. If it is `full`, because stirring no longer helps, or
/// `hit_limit` or `cancelled`, `in_box` holds the spheres that are free of overlap, in the order that
/// they had. The last spheres are left out, about as many as it takes for the others to come free, so that
/// the distribution of sizes stays. Where overlaps are left nevertheless, the sphere that overlaps most
/// others goes, again and again. Radii do not change. Deterministic in the seed.
///
/// Precondition: `Task::target_edges` is set. Throws Error{bad_scene} if a sphere overlaps its own image.
/// Cost: some hundred sweeps of 11 to 130 ns a sphere, some thousand near random close packing; 2,000 equal
/// spheres to 0.62 in three dimensions 0.02 s, to 0.435 in four 0.1 s, to 0.065 in eight 0.3 s.
StageEnd fill_by_relaxation(SpheresInBox& in_box, Reporter& report, const FillOptions& options);

}  // namespace bernal
