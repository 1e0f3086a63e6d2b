#pragma once
#include "bernal/core/spheres.hpp"
#include "soft/relax.hpp"

namespace bernal {

/// Whether `relax_fast` can work: up to three dimensions take a box at least four of the largest radii wide.
template <int D>
bool fast_path_exists(const Spheres<D>& spheres, const Vector<D>& edges);

/// The published relaxation on sorted arrays, with neighbour lists and over-relaxed steps: some hundred times
/// as fast as the loop of the paper, and a little denser. It differs from that in six things.
///  - A sphere moves by min(omega / n, 1) times the sum of its n overlaps, omega about 5. The paper's 1 / n
///  is
///    a third of a Newton step at the five or six contacts of a packed sphere.
///  - Of a pair the larger sphere gives way less, in proportion to the radii (SoftKernels::sweep): the mean
///    over all contacts would leave it where its many small neighbours hold it.
///  - Spheres are swept in an order in which many can be moved at once.
///  - Where molr < 0.003, when it falls in proportion with the growth of the box, the next growth is 0.9 of
///    what the last two predict, at most molr / 6.
///  - Beyond 10,000 spheres the number of sweeps between two growths stays what it is there: the packing
///    fraction does so too.
///  - It ends with overlaps far below `options.stop`.
/// From four dimensions on, and between walls, spheres are swept one after the other, on lists for one size
/// (NeighborRelaxation).
/// Preconditions and results are those of `relax_by_the_book`. Cost: about 13 ns a sphere and sweep, lists
/// included; 0.07 µs in four dimensions and 0.13 µs in eight, lists not included.
template <int D>
StageEnd relax_fast(Spheres<D>& spheres, Vector<D>& edges, Work& work, const RelaxOptions& options);

}  // namespace bernal
