#pragma once
#include <cstdint>

#include <Eigen/Core>

#include "jam/few_energy.hpp"

namespace bernal {

/// From a minimum under a load that overlaps contacts by the ratio `overlap` to the arrangement that it comes
/// from as the load goes to zero, to about 1e-13 of s: the load falls by steps, and under each the minimum is
/// found by Newton's method with the exact solution of its equations, without the part of the second
/// derivative that vanishes with the overlaps (Levenberg and Marquardt). The point is that of the largest s
/// on the way at which nothing overlaps, and has that s. Returns how many systems of equations were solved.
/// Cost of one: (D N)³ / 6 multiplications; some 50 to 200 are. `polish_in_container` closes the same
/// contacts, of many spheres with conjugate gradients and in seconds, and holds radii to what is given.
std::uint64_t close_few(FewEnergy& energy, Eigen::VectorXd& point, double overlap);

}  // namespace bernal
