#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "bernal/hard/grow.hpp"
#include "hard/walls.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Growth in a periodic box, possibly with walls along some axes: hard spheres fly, collide and grow in
/// proportion to their radii until they jam or reach the target (Lubachevsky & Stillinger, J. Stat. Phys. 60,
/// 561 (1990); for any sizes Kansal, Torquato & Stillinger, J. Chem. Phys. 117, 8212 (2002)). The result has
/// the given radii: the box is scaled instead. Spheres with positions start from them, so growth compresses
/// the packing of an earlier stage.
///
/// Schedule: ten times faster than `rate` while the spheres are a fluid (factor Z = P V / N k T below 4 D),
/// which costs no packing fraction (10,000 equal spheres: 0.6447 with it, 0.6443 at `rate` throughout); then
/// `rate`, which determines the final density. At Z gaps are about D / Z of a diameter.
///
/// Masses: for sizes that differ several times, those of one material, `Masses::by_volume`, give denser
/// packings at low rates; with equal masses slower growth gains little. Diameters 5:1, 10,000 spheres, by the
/// volume share of the small ones: the rod model's prediction, and the difference of the result at pressure
/// 1e4.
///
/// | small                   | 0.05   | 0.10   | 0.15   | 0.21   | 0.30   | 0.50   | 0.75   |
/// |-------------------------|--------|--------|--------|--------|--------|--------|--------|
/// | rod model               | 0.6774 | 0.7150 | 0.7570 | 0.7878 | 0.7737 | 0.7338 | 0.6863 |
/// | equal, rate 0.01        | -0.012 | -0.018 | -0.022 | -0.015 | -0.005 |  0.000 | +0.003 |
/// | by volume, rate 0.01    |        | -0.015 | -0.021 | -0.014 |        |        |        |
/// | by volume, rate 0.0025  |        | -0.012 | -0.015 | -0.009 |        |        |        |
///
/// One packing each, except means of four and two at 0.10 and 0.21 with the lowest rate; below a third small
/// the seed changes the result by 0.002 to 0.003. At 0.15 a rate of 0.0006 gives -0.014. Up to there the
/// model's value is that of large spheres alone at random close packing, 0.6435 over their share, which
/// requires that no small sphere keeps two large ones apart.
///
/// Ends `converged` when jammed or at the target; `hit_limit` if the box became too narrow for the minimum
/// image: 2.5 of the largest diameters, except along axes with walls. Throws Error{bad_scene} if it is too
/// narrow at the start, or if phi_init is denser than random insertion reaches. Precondition: 2 to 6
/// dimensions. Cost: about 2,000 collisions a sphere at 0.5 to 0.8 µs. One thread.
StageEnd grow(const Grow& options, SpheresInBox& in_box, Reporter& report);

/// Growth in a container of two or three dimensions with the drawn sizes: hard spheres fly, collide with each
/// other and the walls, and grow in proportion until they have their radii (Lubachevsky & Stillinger, J.
/// Stat. Phys. 60, 561 (1990); at a wall v_n -> -v_n - 2 r').
///
/// The number of spheres is the target's or the expected one. They start at the share of their radii that
/// fills phi_init of the container: those in the bed at their positions, the others by random sequential
/// insertion (at half of phi_init if that fails). If they jam before they reach their radii, this shows how
/// many fit: the tail of the drawn sequence is removed, the rest shrinks until it is a fluid again and
/// continues to grow, a few times at most. So the result is the start of the drawn sequence. Schedule and
/// pressure are those of growth in a periodic box, with the cube root of the container's volume as length.
///
/// The walls of a convex container are those of `convex_walls`: facets in one plane to 1e-4 of the smallest
/// radius count as one. Those of any other are `FacetedWalls`, of a solid of revolution inside of it by up to
/// 1e-3 of that radius. Where a tenth less than is expected has grown among facets, spheres begin
/// anew whose centres keep the whole radius away from walls while they are still small, so that none gets
/// into a groove or a neck in which it has no room in the end. The result does not rely on this: all spheres
/// enter the bed by the same test as in any other stage. They end with their radii and the skin of the bed,
/// 1e-9.
///
/// Ends `converged` with all requested or expected spheres, `full` with those that fitted. Throws
/// Error{bad_scene} if the largest sphere does not fit into the container, or if insertion finds no position
/// at all. Cost: that of growth in a periodic box, about 2,000 collisions a sphere at 0.5 to 0.8 µs, up to
/// twice as much between facets; as much again after each removal. Han's cylinder (R = 1, H = 2, r = 0.0309):
/// 0.60 in 17 s, 0.62 in 24 s, for which relaxation takes 0.8 s and 2.7 s; 0.63 in 41 s, while relaxation
/// ends at 0.6288 after 59 s. One thread.
StageEnd grow_in_container(const Grow& options, SpheresInBed& in_bed, Reporter& report);

/// Its effects with their prices.
std::vector<PlanItem> effects_of_growth(const Grow& options, const Outlook& outlook);

/// The region of growth: a periodic box, or the region between walls or facets in it, with its volume.
template <int D>
struct Arena {
  Vector<D> edges;
  std::vector<Wall<D>> walls;
  double volume;
  std::shared_ptr<const FacetedWalls> facets = {};
  double room_at_walls = 0;  ///< as `HardSphereOptions::room_at_walls`
};

struct Grown {
  StageEnd end;
  double size;  ///< final ratio of the radii to the given ones
};

/// The common part of all growth: spheres fly until their radii are `largest` times the given ones, they jam,
/// or the box has become too narrow (hit_limit). Moves the centres; radii do not change. `report` is called
/// now and then with the current size and progress.
template <int D>
Grown grow_to(double largest, Spheres<D>& spheres, const Arena<D>& arena, Reporter& report,
              const Grow& options, const std::function<void(double size, double done)>& on_growth);

}  // namespace bernal
