#pragma once
#include "bernal/settle/insert.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Random sequential insertion: the remaining spheres, in order, each at a uniformly random position where it
/// overlaps nothing (Han, Feng & Owen 2005, section 2: the initial packing). Ends when the target or the
/// given packing fraction is reached, or when no sphere of the window found a position. Cost: O(1) a trial.
StageEnd insert(const Insert& options, SpheresInBed& in_bed, Reporter& report);

/// The same at the sites of a face-centred lattice, each sphere at the next site where it fits: the sites are
/// in random order, so that ordered sizes make no pattern. The lattice is the widest with enough sites,
/// inside the container and free of present spheres, for the spheres to be placed, and no denser than
/// touching spheres of the largest size; for unequal sizes the remaining spheres are then tried at the sites
/// of lattices of half and a quarter of that spacing, between the others. Its cell is orthogonal, and
/// stretched to divide the container's periods.
///
/// Face-centred, because no lattice is denser: 0.74 of equal spheres, against 0.52 for a simple cubic one.
/// For the same reason that of discs is hexagonal: 0.91. Cost: about twenty passes over as many sites as
/// spheres, O(1) each.
StageEnd insert_on_lattice(const Insert& options, SpheresInBed& in_bed, Reporter& report);

/// The packing fraction at which that ends in an empty container: for equal spheres within 0.04 if x =
/// `bed.wall_share` < 0.7 (containers a few spheres wide are irregular); for unequal sizes within a factor of
/// two.
double full_lattice(const EmptyBed& bed);

/// The same at the sites of a crystal along the coordinate axes, from the floor up, laid so that it has the
/// most sites of some ways to lay it; in boxes with a plane of sites at the lower walls. Throws
/// Error{bad_scene} where it does not divide the container's periods, with the nearest that it divides, and
/// for a spacing below the largest diameter. Cost: O(1) a site, for up to some dozen ways.
StageEnd insert_crystal(const Insert& options, SpheresInBed& in_bed, Reporter& report);
/// The sites that it takes: those of that crystal with room for the largest sphere beside what is in the bed.
/// Throws Cancelled too.
std::vector<Vector<3>> crystal_sites(const Insert& options, const SpheresInBed& in_bed,
                                     const Monitor& monitor);
/// The same in a periodic box of given size, of which it has to divide the periods.
StageEnd insert_crystal_in_box(const Insert& options, SpheresInBox& in_box, Reporter& report);
/// How much denser it is than random packings of equal spheres, in a periodic box; below 1 where it is
/// looser.
double gain_of_crystal(const Insert& options, const SizeDistribution& radii, int dimension,
                       const WallsAround& around);

/// The packing fraction at which that ends in an empty container.
double full_crystal(const Insert& options, const EmptyBed& bed);

/// Throws Error{bad_scene} for keys that do not go together; says where insertion stops.
void complete_insert(Insert& insert, Scene& scene, const schema::Section& section);

/// Until no further sphere finds a position.
inline constexpr Insert until_full = {.attempts = 1000, .packing_fraction = 1};

/// The same for all requested spheres, from the start, the largest first: for sizes some of which hardly fit
/// once small ones are placed. Spheres that find no position are skipped. Ends immediately when it can no
/// longer become that dense.
StageEnd insert_largest_first(SpheresInBed& in_bed, Reporter& report, double densest_so_far = 0);

/// After a stage that moves all spheres at once and could place no more: a few large spheres, with hardly any
/// play between the walls, may have kept all others from coming free. If far fewer than the requested and
/// likely number are placed, or if few are requested, insertion in an empty bed is tried as well; and if
/// hardly any are left, these are inserted, skipping those without a position. Returns how the last of these
/// ended.
StageEnd insert_what_else_fits(SpheresInBed& in_bed, Reporter& report, StageEnd end);

/// Its effects with their prices.
std::vector<PlanItem> effects_of_insertion(const Insert& options, const Outlook& outlook);

}  // namespace bernal
