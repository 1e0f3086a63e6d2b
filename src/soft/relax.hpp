#pragma once
#include <cstddef>

#include "bernal/soft/relax.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Below this share of the packing fraction that is likely to fit, random insertion finds places free of
/// overlap.
inline constexpr double dilute = 0.3;

/// The paper's phi0 in three dimensions; in others the packing fraction that is as far above random close
/// packing.
inline double dense_start(int dimension) {
  constexpr double by_dimension[] = {1.34, 1.13, 0.86, 0.62, 0.42, 0.27, 0.16, 0.093};
  return by_dimension[dimension - 1];
}

/// The effects of the stage, with their prices.
std::vector<PlanItem> effects_of_relaxation(const Relax& options, const Outlook& outlook);
/// Lists and relaxation that take this time together.
std::vector<PlanItem> effects_of_pushing(double seconds, const Outlook& outlook, std::string what);
/// The time that filling a box by relaxation is expected to take.
double seconds_of_filling_box(const Outlook& outlook);

/// Sweeps between two growths of the box: `options.period`, or T = alpha (log10 N)², rounded, at least 1
/// (equation 6; figure 5 holds the two against each other).
int sweeps_a_cycle(const Relax& options, std::size_t spheres);

/// Relaxation in a periodic box (Zhao, Li & Liu 2007). Spheres start at random places in a box so small that
/// they overlap. In a sweep each sphere that overlaps others moves to the mean of the places at which it
/// would just touch one of them (equations 3 and 4). After T = alpha (log10 N)² sweeps the box grows, L <- L
/// (1 + molr / beta), where molr is the largest overlap ratio (ri + rj - d) / (ri + rj) of a pair. The loop
/// ends when molr < stop. Then the box grows by exactly the last overlap, so that none is left.
///
/// phi0 decides how dense the result becomes: in three dimensions 0.86 for random close packing, 0.60 to 0.65
/// for random loose packing. If the scene asks for a box that is larger than the result, all spheres move
/// apart in proportion. If that box is much larger, or larger than the one of phi0, the spheres are relaxed
/// in it instead. Spheres that have places already keep them, relative to the box.
///
/// Cost: about alpha (log10 N)² ln(1/stop) sweeps. When it is cancelled, the spheres are free of overlap in a
/// box that is larger than necessary.
StageEnd relax(const Relax& options, SpheresInBox& in_box, Reporter& report);

/// The published loop as it stands, in double: the method of the paper, and the oracle of the fast engine. A
/// sweep moves spheres in place, in the order of their numbers, and finds them by the background grid and its
/// doubly linked lists. In a box less than two diameters across a sphere overlaps several images of another;
/// all of them push. The paper leaves four points open: here lg is log10; T is rounded and at least 1;
/// centres scale with the box; molr is the largest overlap ratio that the last sweep met.
///
/// `options.settle` adds the paper's rule that a sphere which touches nothing moves to touch its nearest
/// neighbour. It is off by default. It changes neither the packing fraction nor the coordination number
/// beyond the scatter of seeds (N = 1,000, three seeds each: 0.6404 with it and 0.6399 without for equal
/// spheres, 0.6625 and 0.6630 for lognormal ones of sigma 0.3). It costs up to a tenth more time, and
/// rattlers then touch a neighbour by this rule and not by chance.
///
/// Preconditions: centres in [0, edges), every edge at least twice the largest radius. On return centres and
/// edges are those of the end; where it converged, overlaps are below `options.stop`, up to the motion of one
/// sweep. Cost: about 0.25 µs a sphere and sweep in three dimensions. Source: Zhao, Li & Liu 2007, section 2
/// and figure 7.
template <int D>
StageEnd relax_by_the_book(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                           const Relax& options);

/// Random close packing in a container with the sizes as they were drawn.
///
/// As many spheres as the target asks for start at random places, overlap, push each other, and are pushed by
/// the walls: a sphere moves by min(omega / n, 1) times the sum of its n overlaps (Zhao, Li & Liu 2007,
/// equations 3 and 4, with a fixed container in place of the growing box). Where they are stuck, radii become
/// two per cent larger for fifty sweeps; if that did not help, or only a few are stuck, the most squeezed
/// spheres go into the largest holes instead, wherever the holes are. When neither helps, the last spheres of
/// the drawn sequence are taken out, as many as the overlaps suggest: the result is the drawn sequence
/// without its tail. If the target is to fill the container, more spheres of the sequence are pushed in until
/// even a few find no room.
///
/// Random insertion does what pushing cannot: where spheres are few (`dilute`), where some fit only if they
/// touch the walls (these are placed first), where far fewer than expected come free of overlap, and for the
/// last few of a count.
///
/// Spheres that are there already keep their places at first. In the end the bed takes each sphere if it
/// fits, as it does for any other stage.
///
/// Cost: 300 sweeps where there is room to spare, some thousand where there is not; about 20 ns a sphere and
/// sweep and 50 ns more for one at the wall.
StageEnd relax_in_container(const Relax& options, SpheresInBed& in_bed, Reporter& report);

/// The same of spheres that will be a bed, and lie in it as chance has it: few do not become a lattice.
/// `rises`: where they do not fit they get more room, and no arrangement of few is searched for.
StageEnd relax_to_pour(const Relax& options, SpheresInBed& in_bed, Reporter& report, bool rises);

}  // namespace bernal
