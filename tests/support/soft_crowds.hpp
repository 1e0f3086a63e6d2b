#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "soft/sweep_order.hpp"

// Overlapping spheres in periodic boxes, for the tests of the fast relaxation.
namespace bernal::testing {

/// `n` spheres at random in a box of the given proportions that they fill, overlaps counted twice, to `phi`.
template <int D>
struct Crowd {
  Spheres<D> spheres;
  Vector<D> edges;

  Crowd(std::size_t n, double phi, Vector<D> proportions, double r_min, double r_max) : edges(proportions) {
    Random random(7, stream(Stream::test));
    double volume = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double r = r_min * std::pow(r_max / r_min, random.uniform());
      spheres.push_back(Vector<D>::Zero(), r);
      volume += std::pow(2 * r, D) * (D == 3 ? 0.5236 : D == 2 ? 0.7854 : 1.0);
    }
    edges *= std::pow(volume / phi / edges.prod(), 1.0 / D);
    for (std::size_t i = 0; i < n; ++i)
      spheres.set_center(i, uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges}));
  }
};

inline Crowd<3> equal_crowd(std::size_t n) { return {n, 0.8, {1, 1, 1}, 1, 1}; }
inline Crowd<3> mixed_crowd(std::size_t n) { return {n, 0.8, {1, 2, 1.5}, 0.2, 1.5}; }

/// The spheres of a crowd as the engine has them.
struct SoftCrowd {
  std::vector<SoftSphere> spheres;
  std::vector<std::uint32_t> ids;
  std::array<double, 3> edges;
  SoftSizes sizes;

  explicit SoftCrowd(const Crowd<3>& crowd) {
    for (int k = 0; k < 3; ++k) edges[static_cast<std::size_t>(k)] = crowd.edges[k];
    std::vector<float> radii;
    for (std::size_t i = 0; i < crowd.spheres.size(); ++i) {
      SoftSphere s{};
      for (std::size_t k = 0; k < 3; ++k)
        s.x[k] = static_cast<std::int32_t>(
            static_cast<std::uint32_t>(crowd.spheres.x[k][i] / edges[k] * 4294967295.0));
      s.r = static_cast<float>(crowd.spheres.r[i]);
      spheres.push_back(s);
      ids.push_back(static_cast<std::uint32_t>(i));
      radii.push_back(s.r);
    }
    sizes = SoftSizes(radii);
  }
};

}  // namespace bernal::testing
