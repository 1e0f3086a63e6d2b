#pragma once
#include "work/work.hpp"

namespace bernal {

/// Takes spheres that overlap a little, or are a little apart, to a jammed, isostatic packing: afterwards the
/// largest overlap ratio of a pair is at most `tolerance`, and every contact that bears force is closed to
/// about that. Radii do not change; centres come back in [0, edge), edges in proportion.
///
/// The spheres become soft under a pressure (JammingEnergy) that falls by factors of ten; at each level the
/// enthalpy is minimised (TrustRegion), the box being one of its unknowns, so that it does not matter on
/// which side of jamming the spheres start. Near jamming overlaps are proportional to the pressure. The
/// potential is smoothed in the same proportion until the contacts are told from the near misses, when the
/// mean overlap is below 1 / (10 N²), and then no longer; with the contacts settled, one more step takes the
/// overlaps to `tolerance`.
///
/// Up to 3,000 spheres equilibrium is reached to 1e-6 of the forces and the number of contacts is the
/// isostatic one, mostly exactly; beyond, where that would take long, to 1e-3, and some of the contacts, the
/// weakest, are still open: 2.3 % of those of 3,000 spheres that were solved no closer.
///
/// Where rounding of the coordinates allows no better, `tolerance` is not reached: 1e-15 edges over the
/// smallest radius. Precondition: overlaps and gaps of neighbours are below about 1e-2; no two centres
/// coincide. Returns hit_limit if `tolerance` was not reached, or equilibrium not to 1e-2. Cost: the
/// Newton steps are many and short rather than hard to solve, as contacts change along the way: seconds for
/// 1,000 spheres, more than half a minute for 3,000, more than a minute for 10,000. Cancelled, it ends within
/// a step. Memory about 1 kB a sphere. One thread; the same bits each time.
template <int D>
StageEnd polish(Spheres<D>& spheres, Vector<D>& edges, double tolerance, Work& work);

/// The end of every stage that lets a periodic box follow from the packing: polishes contacts to the overlap
/// ratio `polish`, if that is above 0; grows or shrinks the box until nothing overlaps more than is allowed;
/// moves the spheres apart in proportion where the scene asks for a larger box; and hands all of it to
/// `work`. Returns `end`, or why polishing ended. Cost: a look at all near pairs, and `polish`.
template <int D>
StageEnd finish_in_periodic_box(Spheres<D> spheres, Vector<D> edges, StageEnd end, double polish, Work& work);

/// Whether the target edges have room for a box of these edges, and for the rounding of moving to them.
template <int D>
bool lies_within(const Spheres<D>& spheres, const Vector<D>& edges, const Vector<D>& target);

}  // namespace bernal
