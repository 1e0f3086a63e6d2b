#pragma once
#include <cstddef>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/vector.hpp"

namespace bernal {

/// An allowed wave vector of a periodic box, Σ n_k b_k with the reciprocal vectors b_k of the cell: in an
/// upright one 2π / edge along each axis.
template <int D>
struct WaveVector {
  Eigen::Matrix<int, D, 1> n;
  double length;
};

/// The allowed wave vectors, by bins of that width from 0 on, at most `most[bin]` of each, one of every two
/// opposite ones. All vectors of a bin are considered if the box is small enough; else some are drawn in
/// random directions, always the same, and rounded to the nearest allowed one.
template <int D>
std::vector<std::vector<WaveVector<D>>> wave_vectors(const TiltedBoundary<D>& boundary, double width,
                                                     const std::vector<std::size_t>& most);

}  // namespace bernal
