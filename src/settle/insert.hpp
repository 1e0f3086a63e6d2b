#pragma once
#include "bernal/settle/insert.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Random sequential insertion: the spheres that are still to come, in order, each at a uniformly random
/// place where it overlaps nothing (Han, Feng & Owen 2005, section 2: the initial packing). Ends when the
/// target or the given packing fraction is reached, or nothing in the window found a place. Cost: O(1) a
/// trial.
StageEnd insert(const Insert& options, SpheresInBed& in_bed, Reporter& report);

/// The same at the sites of a face-centred lattice, each sphere at the next that has room for it: the sites
/// in random order, so that sizes which come in some order make no pattern. The lattice is the widest whose
/// sites, in the container and clear of what stands there, hold what is to be placed, and no denser than
/// spheres as large as the largest of these touch; of sizes that differ, those that are still to come are
/// then tried at the sites of lattices of half and of a quarter of that, between the others. Its cell is
/// orthogonal, and stretched so that it divides the periods of the container.
///
/// Face-centred, because no lattice holds more: 0.74 of equal spheres, where a simple cubic one ends at 0.52.
/// For the same reason that of discs is hexagonal: 0.91.
/// Cost: about twenty looks at as many sites as spheres, O(1) each.
StageEnd insert_on_lattice(const Insert& options, SpheresInBed& in_bed, Reporter& report);

/// The packing fraction at which that ends, of an empty container: of equal spheres within 0.04 where x =
/// `bed.wall_share` < 0.7, in containers a few spheres wide whatever they happen to hold; of sizes that
/// differ within a factor of two.
double full_lattice(const EmptyBed& bed);

/// Until nothing more finds a place.
inline constexpr Insert until_full = {.attempts = 1000, .packing_fraction = 1};

/// The same for all that are asked for, anew, but the largest first: for sizes of which some have hardly any
/// room where small ones stand. What finds no place is passed over. Ends at once when it can no longer become
/// as dense as that.
StageEnd insert_largest_first(SpheresInBed& in_bed, Reporter& report, double densest_so_far = 0);

/// After a stage that moves all spheres at once and could place no more: a few large ones, with hardly any
/// play between the walls, may have kept all of them from coming free. Where there is much less than is asked
/// for and likely to fit, or where few are asked for, insertion in an empty bed is tried as well; and where
/// hardly any are left, these are inserted, and one that has no place is passed over. Returns how the two
/// ended.
StageEnd insert_what_else_fits(SpheresInBed& in_bed, Reporter& report, StageEnd end);

/// What it brings with it, with its price.
std::vector<PlanItem> effects_of_insertion(const Insert& options, const Outlook& outlook);

}  // namespace bernal
