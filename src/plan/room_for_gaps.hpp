#pragma once
#include "bernal/plan/plan.hpp"

namespace bernal {

// Where a scene asks for gaps, its stages pack spheres with half of the gap around them: of the radius
// R = r + gap / 2, between walls that stand so much nearer, or farther, that a sphere of that radius which
// touches one keeps the wall's gap. Whatever the stages leave free of overlap then keeps the gaps: |ci - cj|
// >= Ri + Rj >= ri + rj + gap, all sums rounded up. No stage and no engine knows of gaps: `build` plans that
// packing, `run` carries it out, and from there on all lengths are those of the scene again. This is the only
// place that leads from one to the other; where the scene asks for no gap there is nothing to lead.
// Where walls are the surface of a CAD file, its triangles are moved in the same way, by the margin.

/// Whether there is anything to lead.
inline bool needs_room(const Plan& plan) { return plan.scene.asks_for_gaps() || margin_of(plan.domain) > 0; }

/// What a sphere has around it: half the gap.
inline double coat_of(const Scene& scene) { return 0.5 * scene.gap; }

/// Throws Error{bad_scene} for gaps that nothing in the scene keeps, or larger than the container.
void require_gaps(const Plan& plan);

/// The plan of what the stages pack, for a scene that asks for gaps. It refers to the sizes of the other.
Plan plan_with_room(const Plan& plan);

/// What is expected of the packing with room for gaps, of the spheres without.
void take_expectations(Plan& plan, const Plan& with_room);

/// How much less far along an axis a place of the packed region is from the origin than in the domain: a
/// periodic box has its origin at zero, and so has what is left between its walls.
double shift_of(const Scene& scene);

/// The edges of a periodic box around a packed region with those edges; and of the region within such a box.
Vector<dynamic> edges_around(const Scene& scene, const Vector<dynamic>& packed);
Vector<dynamic> edges_within(const Scene& scene, const Vector<dynamic>& box);

}  // namespace bernal
