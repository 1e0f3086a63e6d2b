#pragma once
#include <cstddef>

#include "bernal/soft/relax.hpp"
#include "work/work.hpp"

namespace bernal {

using RelaxOptions = Relax;

/// T = alpha (log10 N)², rounded, at least 1 (equation 6).
int sweeps_a_cycle(double alpha, std::size_t spheres);

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
StageEnd relax(Work& work, const RelaxOptions& options);

}  // namespace bernal
