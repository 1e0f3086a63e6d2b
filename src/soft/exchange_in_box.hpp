#pragma once
#include <optional>

#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Spheres in a periodic box, or between its walls, that hardly overlap are crowded a little and exchange
/// their sizes (`SizeExchange`), while the box shrinks as that makes room. Returns the largest overlap ratio;
/// nothing, and changes nothing, where there is nothing to exchange: where all sizes are equal, or too far
/// apart, and in one dimension. `wide` says that they differ widely, as of `is_for_wide_sizes`.
///
/// On return each sphere has the radius that it had, the centres are elsewhere, `edges` are those of the
/// smaller box, and overlap ratios are some hundredths: to be relaxed from there, while the box grows.
/// Cancelled, it returns early. The same bits for any number of threads. Cost: 30,000 sweeps and 6,000 sorts,
/// 0.6 ms a sphere in three dimensions.
template <int D>
std::optional<double> exchange_in_box(Spheres<D>& spheres, Vector<D>& edges, bool wide, SpheresInBox& in_box,
                                      Reporter& report);

}  // namespace bernal
