#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

struct CellWeightOptions {
  double tolerance = 1e-11;  ///< largest deviation of a volume from what is wanted, over that
  int most_steps = 100;
};

/// Weights w of given centres for which the cells of the power (Laguerre) diagram,
///   |p - ci|² - wi <= |p - cj|² - wj  for all j, images included,
/// have given volumes.
struct CellWeights {
  std::vector<double> weights;  ///< squared lengths; only their differences matter: the mean is that of r²
  std::vector<double> volumes;  ///< of the cells
  std::vector<double> sphericity;  ///< of the cells: the surface of a ball of that volume over theirs
  double error = 0;                ///< largest deviation of a volume from what is wanted, over that
  int steps = 0;                   ///< of Newton's method
};

/// The weights exist for any positive volumes whose sum is that of the domain, and are unique but for a
/// constant: those at which the concave function Σ (∫ over cell i of |p - ci|² - wi) + Σ wi Vi is largest.
/// Its gradient is what the volumes lack, its Hessian the Laplacian of the areas of the faces over twice the
/// distances of the centres. Newton's steps start from w = r² and are halved until the least cell keeps half
/// of its first or wanted volume, and the residual falls by half of what the step promises; that converges
/// from any start at which no cell is empty, such as spheres that do not overlap.
///
/// `volumes`, one a sphere, are positive; they are scaled so that their sum is the volume of the domain.
/// Preconditions: a Box of three dimensions, periodic or between walls; centres in it. The result is the same
/// for any number of threads. Cost: for each step, 5 to 10 of them, what all cells cost, see
/// `local_packing`, and some hundred products with a matrix of 15 N entries. Throws Error{bad_argument} where
/// a precondition fails or a cell is empty at the start, and Cancelled as `local_packing` does. Where
/// `most_steps` or rounding end it before, `error` is above `tolerance`: ask for it.
/// Source: Kitagawa, Mérigot & Thibert, J. Eur. Math. Soc. 21 (2019) 2603; for grains, Bourne, Kok, Roper &
/// Spanjer, Phil. Mag. 100 (2020) 2677.
CellWeights weights_for_volumes(const Spheres<dynamic>& spheres, const Domain& domain,
                                std::span<const double> volumes, const CellWeightOptions& = {});

/// Spheres of the same centres whose squared radii are the weights plus a constant, which leaves the cells as
/// they are: what functions of cells of spheres take for those of weights. Radii are of the order of the
/// spheres' own, and may overlap. Precondition: one weight a sphere, or none, which leaves the spheres alone.
Spheres<dynamic> with_weights(const Spheres<dynamic>& spheres, std::span<const double> weights);

}  // namespace bernal
