#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/soft/relax.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Sizes are wide from this ratio on, of the mean radius by volume to the mean by number. Lognormal sizes of
/// sigma 0.5 have 2.40, two sizes 1:5 with a fifth of the volume small 3.7, Fuller's of exponent 1/2 and 1:10
/// have 2.9.
inline constexpr double wide_sizes_from = 2.45;

/// Whether relaxation treats sizes as wide, and starts with the largest spheres.
bool is_for_wide_sizes(const FillTask& task, const Relax& options);

/// The share of `sweeps_a_cycle` between two growths of the box if sizes are wide.
inline constexpr double share_of_cycle = 0.4;

/// The share of the work before the box grows, if spheres are placed from the largest on.
inline constexpr double share_of_placing = 0.45;

/// The default packing fraction at the start: a little above what can be reached, and nearer to it than the
/// default for equal spheres.
inline double wide_start(const FillTask& task) { return 1.06 * task.attainable; }

/// Gives all spheres places in a box in which they overlap, octave by octave of their sizes, the largest
/// first. The spheres of an octave come to random places between the larger ones, with some trials to find
/// room. Then all spheres that are there are relaxed together until that no longer helps.
///
/// If all sizes start at random places, small spheres jam in the throats between large ones before these
/// touch each other, while the pores are half empty. Of two sizes 1:5, a fifth of the volume small, the large
/// ones then end at 0.609 of the box in place of 0.624, and 97 in 100 small ones rattle (N = 10,000).
///
/// Precondition: every edge is at least the largest diameter. Cost: some hundred sweeps for each octave.
template <int D>
StageEnd place_from_largest(Spheres<D>& spheres, const Vector<D>& edges, const SpheresInBox& in_box,
                            Reporter& report, const Relax& options);
/// Relaxation in a growing box for wide sizes. The box grows by the mean overlap divided by beta, and not by
/// the largest: the mean by number or by volume, whichever is larger. One small sphere between two large ones
/// may overlap them by half of its size for long, and by the largest overlap the box would grow by half
/// before the other spheres have packed. In the long run the largest overlap takes over, so that the loop
/// ends.
///
/// `overlap` is the largest overlap ratio at the start, 1 if it is not known; the share `before` of the work
/// is over then. Preconditions and results are those of `relax_by_the_book`. Cost: about 20 ns a sphere and
/// sweep, lists included.
template <int D>
StageEnd relax_wide(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                    const Relax& options, double overlap, double before);

}  // namespace bernal
