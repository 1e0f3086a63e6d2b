#pragma once
#include <functional>
#include <vector>

#include "bernal/hard/grow.hpp"
#include "hard/walls.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// Growth in a periodic box, which may end at walls along some axes: hard spheres fly, collide and grow in
/// proportion to their radii until they jam or fill the box as asked (Lubachevsky & Stillinger, J. Stat.
/// Phys. 60, 561 (1990); for any sizes Kansal, Torquato & Stillinger, J. Chem. Phys. 117, 8212 (2002)). The
/// radii of the result are the given ones: it is the box that is scaled. Spheres that have places already
/// start from them, so growth compresses what another stage left.
///
/// Schedule: ten times faster than `rate` while the spheres are a fluid (factor Z = P V / N k T below 4 D),
/// which costs no packing fraction (10,000 equal spheres: 0.6447 with it, 0.6443 at `rate` throughout); then
/// `rate`, which decides how dense the packing becomes. At Z gaps are about D / Z of a
/// diameter.
///
/// Masses: where sizes differ several times those of one material, `Masses::by_volume`, make denser packings
/// if the rate is low; with equal masses slower growth gains little. Diameters 5:1, 10,000 spheres, by the
/// share of the volume that is small: what the rod model predicts, and what comes of it up to pressure 1e4.
///
/// | small                   | 0.05   | 0.10   | 0.15   | 0.21   | 0.30   | 0.50   | 0.75   |
/// |-------------------------|--------|--------|--------|--------|--------|--------|--------|
/// | rod model               | 0.6774 | 0.7150 | 0.7570 | 0.7878 | 0.7737 | 0.7338 | 0.6863 |
/// | equal, rate 0.01        | -0.012 | -0.018 | -0.022 | -0.015 | -0.005 |  0.000 | +0.003 |
/// | by volume, rate 0.01    |        | -0.015 | -0.021 | -0.014 |        |        |        |
/// | by volume, rate 0.0025  |        | -0.012 | -0.015 | -0.009 |        |        |        |
///
/// One packing each, at 0.10 and 0.21 with patience the mean of four and two; below a third small the seed
/// decides 0.002 to 0.003. At 0.15 a rate of 0.0006 gives -0.014. Up to there the model's value is what large
/// spheres alone at random close packing would leave, 0.6435 over their share: no small sphere may then keep
/// two large ones apart.
///
/// Ends `converged` jammed or where the target is reached; `hit_limit` where the box has become too narrow
/// for the minimum image: 2.5 of the largest diameters, but along axes with walls. Throws Error{bad_scene} if
/// it is that from the start, or if phi_init is denser than random insertion reaches. Precondition: 2 to 6
/// dimensions. Cost: some 2,000 collisions a sphere at 0.5 to 0.8 µs. One thread.
StageEnd grow(const Grow& options, SpheresInBox& in_box, Reporter& report);

/// Growth in a convex container with the sizes as they were drawn: hard spheres fly, collide with each other
/// and the walls, and grow in proportion until they have their radii (Lubachevsky & Stillinger, J. Stat.
/// Phys. 60, 561 (1990); at a wall v_n -> -v_n - 2 r').
///
/// As many spheres as the target asks for, or as the plan expects, start with a share of their radii at which
/// they fill phi_init of the container: those in the bed where they are, the others by random sequential
/// insertion; where that gets stuck, with half of phi_init. What jams before its radii are reached shows how
/// many spheres the container has room for: the tail of the drawn sequence is taken out, what is left shrinks
/// until it is a fluid again and goes on growing, a few times at most. So the result is the drawn sequence
/// less its tail. Schedule and pressure are those of growth in a periodic box, with the cube root of the
/// container's volume for its length.
///
/// The walls are those of `convex_walls`: facets in one plane to 1e-4 of the smallest radius count as one.
/// Nothing is left to that: all spheres come into the bed by the same question as those of any other stage,
/// whether they fit. Spheres end with their radii and the skin of the bed, 1e-9.
///
/// Ends `converged` with all spheres that were asked for or expected, `full` with those that found room.
/// Throws Error{bad_scene} if the container is not convex, if the largest sphere does not fit into it, or if
/// insertion finds no places at all. Cost: that of growth in a periodic box, some 2,000 collisions a sphere
/// at 0.5 to 0.8 µs; as much again after spheres were taken out. Han's cylinder (R = 1, H = 2, r = 0.0309):
/// 0.60 in 17 s, 0.62 in 24 s, where relaxation takes 0.8 s and 2.7 s; 0.63 in 41 s, where relaxation ends at
/// 0.6288 after 59 s. One thread.
StageEnd grow_in_container(const Grow& options, SpheresInBed& in_bed, Reporter& report);

/// What it brings with it, with its price.
std::vector<PlanItem> effects_of_growth(const Grow& options, const Outlook& outlook);

/// The walls that growth takes the shape to have. Throws Error{bad_scene} if it is not convex.
std::vector<Wall<3>> walls_for_growth(const Domain& shape, double smallest_radius);

/// Where spheres fly while they grow: a periodic box, or the region between walls in it, of this volume.
template <int D>
struct Arena {
  Vector<D> edges;
  std::vector<Wall<D>> walls;
  double volume;
};

struct Grown {
  StageEnd end;
  double size;  ///< that radii have reached, in given ones
};

/// What all growth consists of: spheres fly until their radii are `largest` times the given ones, or they
/// jam, or the box has become too narrow: then it ends with hit_limit. Moves the centres; radii stay as they
/// are. `on_growth` is called now and then, with the size that the spheres have and how far that is.
template <int D>
Grown grow_to(double largest, Spheres<D>& spheres, const Arena<D>& arena, Reporter& report,
              const Grow& options, const std::function<void(double size, double done)>& on_growth);

}  // namespace bernal
