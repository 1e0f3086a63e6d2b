#pragma once
#include <cstddef>
#include <vector>

#include "bernal/core/spheres.hpp"

namespace bernal {

/// The volume of the spheres, of discs their area, in each of `layers` equal slices from the height `from`
/// on, where heights are those along `up`, a unit vector; what is beyond the slices counts in the first or
/// the last one. Exact to rounding.
std::vector<double> filled_slices(const Spheres<3>&, int dimension, const Vector<3>& up, double from,
                                  double thickness, std::size_t layers);

}  // namespace bernal
