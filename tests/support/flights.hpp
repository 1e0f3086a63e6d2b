#pragma once
#include <cmath>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/dimension.hpp"
#include "hard/hard_spheres.hpp"
#include "near/cell_grid.hpp"

namespace bernal::testing {

/// Spheres at random places in a cube that they fill to `phi`, free of overlap.
template <int D>
struct Gas {
  Spheres<D> spheres;
  Vector<D> edges;

  Gas(const std::vector<double>& radii, double phi, std::uint64_t seed = 1) {
    double volume = 0;
    for (const double r : radii) volume += ball_volume(D, r);
    edges = Vector<D>::Constant(std::pow(volume / phi, 1.0 / D));
    const Boundary<D> boundary{edges};
    Random random(seed, stream(Stream::test));
    const auto [least, most] = std::ranges::minmax(radii);
    CellGrid<D> grid(boundary, least, most, radii.size());
    for (const double r : radii) {
      for (;;) {
        const Vector<D> c = uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges});
        const auto i = static_cast<std::uint32_t>(spheres.size());
        if (grid.any_near(c, r, [&](auto j) {
              return boundary.minimum_image(c - spheres.center(j)).norm() < r + spheres.r[j];
            }))
          continue;
        spheres.push_back(c, r);
        grid.insert(i, c, r);
        break;
      }
    }
  }
};

inline std::vector<double> equal_radii(std::size_t n) { return std::vector<double>(n, 0.5); }

/// Lognormal by number, the largest first, so that random insertion goes through.
inline std::vector<double> lognormal_radii(std::size_t n, double sigma, std::uint64_t seed = 1) {
  Random random(seed, stream(Stream::test, 1));
  std::vector<double> radii;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = 1 - random.uniform(), v = random.uniform();
    radii.push_back(0.5 * std::exp(sigma * std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v)));
  }
  std::ranges::sort(radii, std::greater<>());
  return radii;
}

}  // namespace bernal::testing
