#pragma once
#include "work/work.hpp"

namespace bernal {

/// The end of every stage that lets a periodic box follow from the packing: polishes contacts to the overlap
/// ratio `polish`, if that is above 0; grows or shrinks the box until nothing overlaps more than is allowed;
/// moves the spheres apart in proportion where the scene asks for a larger box; and hands all of it to
/// `work`. Returns `end`, or why polishing ended. Cost: a look at all near pairs, and `polish`.
template <int D>
StageEnd finish_in_periodic_box(Spheres<D> spheres, Vector<D> edges, StageEnd end, double polish, Work& work);

/// Grows or shrinks the box until nothing overlaps more than is allowed, or crosses its walls. Centres that
/// coincide are parted.
template <int D>
void free_of_overlap(Spheres<D>& spheres, Vector<D>& edges, Work& work);

/// Whether the target edges have room for a box of these edges, and for the rounding of moving to them.
template <int D>
bool fits(const Spheres<D>& spheres, const Vector<D>& edges, const Vector<D>& target);

/// Moves every sphere by `length` in a direction of its own; walls stop its centre.
template <int D>
void shake(Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls, double length,
           Random random);

}  // namespace bernal
