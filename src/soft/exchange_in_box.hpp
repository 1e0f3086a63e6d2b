#pragma once
#include <optional>

#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Compresses spheres that hardly overlap a little, and lets them exchange their sizes (`SizeExchange`) while
/// the box shrinks as that makes room. The box is periodic, or has walls. Returns the largest overlap ratio.
/// If no sizes can be exchanged, because all are equal or too far apart, or in one dimension, it returns
/// nothing and changes nothing. `wide` is `is_for_wide_sizes`.
///
/// On return each sphere has the radius that it had, centres are elsewhere, `edges` are those of the smaller
/// box, and overlap ratios are some hundredths: relaxation in a growing box goes on from there. When it is
/// cancelled, it returns early. The same bits for any number of threads. Cost: 30,000 sweeps and 6,000 sorts,
/// 0.6 ms a sphere in three dimensions.
template <int D>
std::optional<double> exchange_in_box(Spheres<D>& spheres, Vector<D>& edges, bool wide, SpheresInBox& in_box,
                                      Reporter& report);

}  // namespace bernal
