#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bernal/domain/container.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Turns spheres with small overlaps or gaps into a jammed, isostatic packing: afterwards the largest overlap
/// ratio of a pair is at most `tolerance`, and every contact that bears force is closed to about that. Radii
/// do not change; centres are returned in [0, edge), edges in proportion.
///
/// The spheres become soft under a pressure (JammingEnergy) that falls by factors of ten; at each level the
/// enthalpy is minimised (TrustRegion) with the box as one of its unknowns, so the spheres may start on
/// either side of jamming. Near jamming overlaps are proportional to the pressure. The potential is smoothed
/// in the same proportion until contacts can be distinguished from near misses, when the mean overlap is
/// below 1 / (10 N²), and not smoothed after that; with the contacts fixed, one more step reduces the
/// overlaps to `tolerance`.
///
/// Up to 3,000 spheres equilibrium is reached to 1e-6 of the forces and the number of contacts is isostatic,
/// usually exactly; for more spheres, which would take long, to 1e-3, and some of the weakest contacts are
/// still open: 2.3 % for 3,000 spheres solved to that accuracy.
///
/// Rounding of the coordinates limits `tolerance` to 1e-15 edges over the smallest radius. Precondition:
/// overlaps and gaps of neighbours are below about 1e-2; no two centres coincide. Returns hit_limit if
/// `tolerance` was not reached, equilibrium not to 1e-2, or fewer contacts bear force than hold the spheres.
/// Cost: many Newton steps that are cheap to solve, because contacts change along the way: seconds for 1,000
/// spheres, more than half a minute for 3,000, more than a minute for 10,000. When cancelled, it ends within
/// a step. Memory about 1 kB a sphere. One thread; the same bits each time.
///
/// Along axes on which the box has walls, by `Task::walls`, wall contacts count like any other, and dilate
/// with the box. In equilibrium the forces of C contacts satisfy D (N - rattlers) balance equations, less one
/// for each common motion of all spheres that no wall prevents (D shifts in a periodic box, one for each axis
/// without walls otherwise). Under pressure there is exactly one solution, so
///   C = D (N - rattlers) - symmetries + 1:
/// the isostatic number, for frictionless spheres under nothing but the pressure.
template <int D>
StageEnd polish(Spheres<D>& spheres, Vector<D>& edges, double tolerance, const SpheresInBox& in_box,
                Reporter& report);

/// The key of a stage that ends with polishing.
template <class Options>
schema::Key polish_key() {
  return schema::buys_accuracy(
      {0, 1e-6, 1e-10},
      schema::number(&Options::polish, "polish",
                     "close the gaps and overlaps of all contacts to this ratio, and no more contacts than "
                     "hold the spheres; in a container all sizes grow for that by one factor, which the "
                     "report states; 0: do not",
                     {0, 0.5}));
}

/// Appends its expected cost, which in a box is also added to the last of the items.
void add_polishing(std::vector<PlanItem>& items, const Outlook& outlook);

/// The result of polishing in a container.
struct Jammed {
  /// More growth than this is not polishing: such spheres are too few to hold each other.
  static constexpr double most_growth = 1.03;
  StageEnd end;
  Spheres<3> spheres;  ///< in the unchanged container, with their original radii
  double growth;       ///< factor for all radii with which contacts close and nothing overlaps
  bool too_loose;      ///< stopped because the factor would exceed `most_growth`
  std::size_t held;    ///< spheres that are not rattlers
  double held_volume;  ///< their share of the volume of all
};

/// The same in a container of two or three dimensions, which does not change: it cannot dilate and the number
/// of spheres is fixed, so all radii grow by one factor until the spheres jam. In units of the radii it is
/// the container that shrinks, so the problem is the same. `symmetries` is `symmetries_of` its domain.
/// Precondition: there are spheres, with centres inside; discs on z = 0, where they stay. Cost: mostly
/// products with the Hessian, 10 ns a contact each, tens to hundreds a Newton step, and one or two thousand
/// steps: 6 to 14 s for 1,000 spheres.
Jammed polish_in_container(const Spheres<3>& spheres, const Container& container, int symmetries,
                           double tolerance, const Monitor& monitor,
                           const std::function<void(double done, double largest_overlap)>& report,
                           Checkpoints* checkpoints = nullptr);

/// The end of every stage that packs a bed: polishes contacts to gap ratios below `polish`, if that is above
/// 0, or to the skin of the bed if that is wider. All sizes grow by one factor, stored in `Supply::scale`
/// for later stages. Returns `end`, or the reason why polishing ended. A bed too loose to be polished does
/// not change, and `Reporter::missed` says so; this includes a bed in which a few spheres, wedged between
/// walls, stop the growth while the rest is loose. Closed contacts are counted on the final positions
/// (`what_is_open`).
StageEnd finish_in_bed(StageEnd end, double polish, SpheresInBed& in_bed, Reporter& report);

/// The end of every stage with a box that follows from the packing: polishes contacts to the overlap ratio
/// `polish`, if that is above 0; scales the box until nothing overlaps more than allowed; moves the spheres
/// apart in proportion if the scene asks for a larger box; and stores all in `work`. Returns `end`, or the
/// reason why polishing ended; `Reporter::missed` says what is open, by the final positions (`what_is_open`)
/// or because of the larger box. Cost: a search of all near pairs, and `polish`.
template <int D>
StageEnd finish_in_periodic_box(Spheres<D> spheres, Vector<D> edges, StageEnd end, double polish,
                                SpheresInBox& in_box, Reporter& report);

/// The end of a stage that polished to `polish` with the result `end`; `open` states which contacts are open.
/// Contacts that do not hold the spheres mean not converged, whatever the solver returned; `Reporter::missed`
/// says so.
StageEnd end_of_polish(StageEnd end, double polish, const std::optional<std::string>& open, Reporter& report);

/// The end of a stage whose box is larger than the spheres need: if `polish` is above 0, contacts that should
/// be closed are open, and `Reporter::missed` says so.
StageEnd end_in_larger_box(StageEnd end, double polish, Reporter& report);

/// Whether a box of these edges fits the target edges, including the rounding of moving to them.
template <int D>
bool lies_within(const Spheres<D>& spheres, const Vector<D>& edges, const Vector<D>& target);

}  // namespace bernal
