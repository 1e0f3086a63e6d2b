#pragma once
#include <cstddef>
#include <functional>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/soft/relax.hpp"
#include "soft/relax_wide.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"

namespace bernal {

struct FirstThatFit {
  Spheres<3> spheres;                  ///< the first of the sequence
  bool is_free = false;                ///< of overlap, with 1e-4 of the radii to spare
  bool is_full = false;                ///< whether it is known that hardly more fit
  StageEnd end = StageEnd::converged;  ///< `full` where spheres are stuck that have to go elsewhere
};

/// Packs the first `count` of the sequence in a container of three dimensions, and then as many more or
/// fewer, up to `most`, as that shows to fit; each time all of them from random places.
///
/// As in a periodic box for wide sizes (`relax_wide`) they are placed from the largest on while they overlap,
/// and part by their mean overlap; but it is the spheres that shrink, from a few per cent larger than asked
/// for on. So each packing tells how many fit. For sizes as wide as `wide_sizes_from` there is no other way
/// that comes as far: what is stirred puts large spheres into holes between small ones. Where as many are
/// asked for as fit, this takes a third of the time of pushing in more and more.
///
/// Radii are larger by the length `larger_by`. `tell` takes the spheres, their largest overlap ratio and the
/// share of the work that is over; `is_over` the sweeps of all spheres so far, and says whether to end there.
/// Cost: two or three packings, each as in a periodic box, and the walls.
FirstThatFit pack_shrinking(const SpheresInBed& in_bed, std::size_t count, std::size_t most, double larger_by,
                            Random& random, Reporter& report, const Relax& options,
                            const std::function<bool(double)>& is_over,
                            const std::function<void(const Spheres<3>&, double, double)>& tell);

}  // namespace bernal
