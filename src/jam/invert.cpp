#include "jam/invert.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace bernal {

void invert_positive_definite(double* matrix, int n) {
  if (n == 1) {  // Eigen would multiply by the reciprocal of the root
    const double root = std::sqrt(*matrix);
    *matrix = 1 / root / root;
    return;
  }
  using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 8, 8>;
  Eigen::Map<Block> block(matrix, n, n);
  block = block.llt().solve(Block::Identity(n, n)).eval();
}

}  // namespace bernal
