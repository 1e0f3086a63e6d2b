#pragma once
#include <cstddef>

#include "bernal/soft/relax.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Spheres that fill less than this share of what is likely to fit find places free of overlap by themselves.
inline constexpr double dilute = 0.3;

/// The paper's phi0, and in other than three dimensions what is as far above random close packing.
inline double dense_start(int dimension) {
  constexpr double by_dimension[] = {1.34, 1.13, 0.86, 0.62, 0.42, 0.27, 0.16, 0.093};
  return by_dimension[dimension - 1];
}

/// What it brings with it, with its price.
std::vector<PlanItem> effects_of_relaxation(const Relax& options, const Outlook& outlook);
/// Lists and relaxation that take so long together.
std::vector<PlanItem> effects_of_pushing(double seconds, const Outlook& outlook, std::string what);
/// What filling a box by relaxation is expected to take.
double seconds_of_filling_box(const Outlook& outlook);

/// Sweeps between two growths of the box: `options.period`, or T = alpha (log10 N)², rounded, at least 1
/// (equation 6; figure 5 holds the two against each other).
int sweeps_a_cycle(const Relax& options, std::size_t spheres);

/// Relaxation in a periodic box (Zhao, Li & Liu 2007): spheres start at random places in a box so small that
/// they overlap. Where spheres overlap, each is moved to the mean of the places at which it would just touch
/// one of them (equations 3 and 4; a sweep). After T = alpha (log10 N)² sweeps the box grows, L <- L (1 +
/// molr / beta), molr being the largest overlap ratio (ri + rj - d) / (ri + rj) of a pair; it ends when molr
/// < stop. Then the box grows by the last overlap, exactly: the result has none.
///
/// phi0 decides how dense the result becomes: in three dimensions 0.86 for random close packing, 0.60 to 0.65
/// for random loose packing. A box that is asked for and larger than the result is met by moving all spheres
/// apart in proportion; where it is much larger, or larger than phi0 makes it, the spheres are relaxed in
/// that box instead. Spheres that have places already keep them, relative to the box.
///
/// Cost: about alpha (log10 N)² ln(1/stop) sweeps. Cancelled, it leaves the spheres free of overlap in a box
/// that is larger than it need be.
StageEnd relax(const Relax& options, SpheresInBox& in_box, Reporter& report);

/// The published loop as it stands, in double: the oracle of the fast path. Spheres are moved in place, in
/// the order of their numbers, and found by the background grid and its doubly linked lists. Where the box
/// has less than two diameters across, a sphere overlaps several
/// images of another, and all of them push. Readings of what the paper leaves open: lg is log10; T is rounded
/// and at least 1; centres are scaled with the box; molr is the largest overlap that the last sweep met.
///
/// `options.settle` adds the paper's rule that a sphere which touches nothing moves to touch its nearest
/// neighbour. It is off by default: it changes neither the packing fraction nor the coordination number
/// beyond the scatter of seeds (N = 1,000, three seeds each: 0.6404 and 0.6399 with and without it for equal
/// spheres, 0.6625 and 0.6630 for lognormal ones of sigma 0.3), costs up to a tenth more time, and leaves
/// rattlers where they touch something by decree and not by chance.
///
/// Preconditions: centres in [0, edges), every edge at least twice the largest radius. On return centres and
/// edges are those of the end; overlaps are below `options.stop` where it converged, to the motion of one
/// sweep. Cost: about 0.25 µs a sphere and sweep in three dimensions. Source: Zhao, Li & Liu 2007, section 2
/// and figure 7.
template <int D>
StageEnd relax_by_the_book(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                           const Relax& options);

/// Random close packing in a container with the sizes as they were drawn.
///
/// As many spheres as the target asks for are put at random places and relaxed: they overlap and push each
/// other and are pushed by the walls, min(omega / n, 1) of the sum of n overlaps at a time (Zhao, Li & Liu
/// 2007, equations 3 and 4, with a fixed container in place of the growing box). Where they get stuck, radii
/// are two per cent larger for fifty sweeps, and every second time the most squeezed spheres are put into the
/// largest holes instead, whatever is between. When that does not help any more, as many of the last of the
/// drawn sequence are taken out as the overlaps suggest: the result is the drawn sequence less its tail.
/// Where the target is to fill the container, more of the sequence are pushed in until even a few find no
/// room.
///
/// Random insertion helps where spheres cannot be pushed: where they are few (`dilute`), where some fit only
/// touching the walls, which stand first, where much less than is likely comes free, and for the last few of
/// a count.
///
/// Spheres that are there already keep their places at first. All are put back into the bed by the same
/// question as those of any other stage: whether they fit.
///
/// Cost: 300 sweeps where there is room to spare, some thousand where there is not; about 20 ns a sphere and
/// sweep and 50 ns more for one at the wall.
StageEnd relax_in_container(const Relax& options, SpheresInBed& in_bed, Reporter& report);

}  // namespace bernal
