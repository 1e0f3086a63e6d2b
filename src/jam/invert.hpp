#pragma once

namespace bernal {

/// Inverts a symmetric positive definite matrix of n rows in place, by its Cholesky factors. Precondition:
/// 1 <= n <= 8. It knows n only when it runs: Eigen's factorisation for a size known beforehand takes the
/// compiler seconds for each size, and gives the same numbers.
void invert_positive_definite(double* matrix, int n);

}  // namespace bernal
