#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bernal/domain/container.hpp"
#include "work/stage_entry.hpp"

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
/// coincide. Returns hit_limit if `tolerance` was not reached, equilibrium not to 1e-2, or fewer contacts
/// bear force than hold the spheres. Cost: the Newton steps are many and short rather than hard to solve, as
/// contacts change along the way: seconds for 1,000 spheres, more than half a minute for 3,000, more than a
/// minute for 10,000. Cancelled, it ends within a step. Memory about 1 kB a sphere. One thread; the same bits
/// each time.
///
/// Along axes on which the box ends at walls, by `Task::walls`, these are contacts like any other, and dilate
/// with the box. In equilibrium the forces of C contacts balance D (N - rattlers) times, of which as many
/// hold anyway as there are motions of all spheres together that no wall feels: D shifts in a periodic box,
/// one for each axis without walls between walls. What bears a pressure has one solution of these equations
/// but no second, so
///   C = D (N - rattlers) - symmetries + 1:
/// the isostatic number, of frictionless spheres that nothing but the pressure presses together.
template <int D>
StageEnd polish(Spheres<D>& spheres, Vector<D>& edges, double tolerance, const SpheresInBox& in_box,
                Reporter& report);

/// The key of a stage that ends with it.
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

/// Appends what it is expected to cost, which in a box the last of the items holds, too.
void add_polishing(std::vector<PlanItem>& items, const Outlook& outlook);

/// Spheres that were polished in a container.
struct Jammed {
  /// More than that is not polishing: such spheres are too few to hold each other.
  static constexpr double most_growth = 1.03;
  StageEnd end;
  Spheres<3> spheres;  ///< in the container as it is; with their radii as they were
  double growth;     ///< by which all radii have to be multiplied so that contacts close and nothing overlaps
  bool too_loose;    ///< it gave up because that would be more than `most_growth`
  std::size_t held;  ///< spheres that are no rattlers
  double held_volume;  ///< their share of the volume of all
};

/// The same in a container, which stays as it is: neither can it dilate nor are there fewer or more spheres,
/// so it is all radii that grow by one factor until they jam. It is the same problem: seen in units of the
/// radii, it is the container that shrinks. `symmetries` is `symmetries_of` its domain. Precondition: there
/// are spheres, with centres inside. Cost: mostly products with the Hessian, 10 ns a contact each, tens to
/// hundreds a Newton step, and a thousand steps or two: 6 to 14 s for 1,000 spheres.
Jammed polish_in_container(const Spheres<3>& spheres, const Container& container, int symmetries,
                           double tolerance, const Monitor& monitor,
                           const std::function<void(double done, double largest_overlap)>& report,
                           Checkpoints* checkpoints = nullptr);

/// The end of every stage that packs a bed: polishes contacts until their gap ratios are below `polish`, if
/// that is above 0, or to the skin of the bed where that is wider. All sizes grow by one factor, which
/// `Supply::scale` holds, for the stages to come too. Returns `end`, or why polishing ended; what is too
/// loose to be polished stays as it is, and `Reporter::missed` says so. So it does where a few spheres,
/// wedged in between walls, keep the sizes from growing until the others hold each other too: the rest is
/// loose. What is said to be closed is counted by the spheres as they lie (`what_is_open`).
StageEnd finish_in_bed(StageEnd end, double polish, SpheresInBed& in_bed, Reporter& report);

/// The end of every stage that lets a periodic box follow from the packing: polishes contacts to the overlap
/// ratio `polish`, if that is above 0; grows or shrinks the box until nothing overlaps more than is allowed;
/// moves the spheres apart in proportion where the scene asks for a larger box; and hands all of it to
/// `in_box`. Returns `end`, or why polishing ended, and `Reporter::missed` says what is open: by the spheres
/// as they lie (`what_is_open`), or because the larger box opened it again. Cost: a look at all near pairs,
/// and `polish`.
template <int D>
StageEnd finish_in_periodic_box(Spheres<D> spheres, Vector<D> edges, StageEnd end, double polish,
                                SpheresInBox& in_box, Reporter& report);

/// The end of a stage that polished to `polish` and came to `end`, where `open` says what was found open:
/// what holds no spheres is not converged, whatever the solver says. `Reporter::missed` tells.
StageEnd end_of_polish(StageEnd end, double polish, const std::optional<std::string>& open, Reporter& report);

/// The end of a stage whose spheres stand in a box that is larger than they need: contacts were to be closed
/// and are open, which `Reporter::missed` says, where `polish` is above 0.
StageEnd end_in_larger_box(StageEnd end, double polish, Reporter& report);

/// Whether the target edges have room for a box of these edges, and for the rounding of moving to them.
template <int D>
bool lies_within(const Spheres<D>& spheres, const Vector<D>& edges, const Vector<D>& target);

}  // namespace bernal
