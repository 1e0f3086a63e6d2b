#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/soft/relax.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Mean radius by volume over the mean by number from which on sizes are wide: beyond lognormal ones of sigma
/// 0.5 (2.40); 1:5 with a fifth of the volume small have 3.7, Fuller's of exponent 1/2 from 1:10 on 2.9.
inline constexpr double wide_sizes_from = 2.45;

/// Whether relaxation in a periodic box goes about it from the largest spheres on.
bool is_for_wide_sizes(const FillTask& task, const Relax& options);

/// Share of `sweeps_a_cycle` that passes between two growths of the box where sizes are wide.
inline constexpr double share_of_cycle = 0.4;

/// Share of the work until the box grows, where spheres are placed from the largest on.
inline constexpr double share_of_placing = 0.45;

/// Packing fraction at the start where nothing but the default is asked for: nearer to what can be reached
/// than that of equal spheres, and above it, however dense that is.
inline double wide_start(const FillTask& task) { return 1.06 * task.attainable; }

/// Gives all spheres places in a box in which they overlap: octave by octave of their sizes, the largest
/// first. Each kind comes at random places into what the larger ones have left, as far as some trials find
/// room there, and then all that are there are relaxed together until that no longer helps.
///
/// From random places small spheres jam around large ones before these are in contact, in the throats between
/// them, while the pores are half empty: of two sizes 1:5, a fifth of the volume small, the large ones then
/// end at 0.609 of the box in place of 0.624, and 97 in 100 small ones rattle (N = 10,000).
///
/// Precondition: every edge is at least the largest diameter. Cost: some hundred
/// sweeps for each octave.
template <int D>
StageEnd place_from_largest(Spheres<D>& spheres, const Vector<D>& edges, const SpheresInBox& in_box,
                            Reporter& report, const Relax& options);

/// As `relax_by_the_book` and the fast path for equal spheres, for sizes that are wide. Between two growths
/// the box grows by the mean overlap, not the largest: by number or by volume, whichever is larger, divided
/// by beta. One small sphere caught between two large ones overlaps them by half for long, and the box would
/// grow by half before the others have had time to pack. The largest overlap takes over in the long run, so
/// that this ends.
///
/// Preconditions and results: as of `relax_by_the_book`, but that every edge is at least the largest
/// diameter. Cost: about 20 ns a sphere and sweep, lists included.
/// `overlap` is the largest overlap ratio to begin with, 1 if that is not known; the share `before` of the
/// work was over then.
template <int D>
StageEnd relax_wide(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                    const Relax& options, double overlap, double before);

}  // namespace bernal
