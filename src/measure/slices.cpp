#include "measure/slices.hpp"

#include <algorithm>

#include "domain/ball_below.hpp"

namespace bernal {

std::vector<double> filled_slices(const Spheres<3>& spheres, int dimension, const Vector<3>& up, double from,
                                  double thickness, std::size_t layers) {
  std::vector<double> filled(layers, 0);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i], z = up.dot(spheres.center(i)) - from;
    const auto layer = [&](double at) {
      return static_cast<std::size_t>(std::clamp(at / thickness, 0.0, static_cast<double>(layers - 1)));
    };
    double before = 0;
    const std::size_t last = layer(z + r);
    for (std::size_t k = layer(z - r); k <= last; ++k) {
      const double top = k == last ? z + r : static_cast<double>(k + 1) * thickness;
      const double below = ball_below(dimension, r, top - z);
      filled[k] += below - before;
      before = below;
    }
  }
  return filled;
}

}  // namespace bernal
