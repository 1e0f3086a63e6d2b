#pragma once
#include <cstddef>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A wave vector that a periodic box allows: its components are 2π n / edge.
template <int D>
struct WaveVector {
  Eigen::Matrix<int, D, 1> n;
  double length;
};

/// Of the allowed wave vectors shorter than bins · width, in order of their bins, at most `most` a bin; of
/// two opposite ones one. All of a bin are looked for where the box is small for them; else some are drawn in
/// random directions, always the same ones, and rounded to the nearest that is allowed.
template <int D>
std::vector<std::vector<WaveVector<D>>> wave_vectors(const Vector<D>& edges, double width, std::size_t bins,
                                                     std::size_t most);

}  // namespace bernal
