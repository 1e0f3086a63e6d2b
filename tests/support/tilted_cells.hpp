#pragma once
#include <cstddef>
#include <cstdint>

#include "bernal/core/boundary.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

// Tilted periodic cells and their images, from the cell vectors by their definition.
namespace bernal::testing::tilted {

struct Cell {
  Vector<3> edges;
  Tilt tilt;
  int images;  ///< that the oracle looks at, to either side

  Box box() const { return periodic_box(edges, {}, tilt); }
  TiltedBoundary<3> boundary() const { return {edges, tilt}; }
  /// (lx, 0, 0), (xy, ly, 0), (xz, yz, lz)
  Vector<3> at(int a, int b, int c) const {
    return {a * edges[0] + b * tilt[0] + c * tilt[1], b * edges[1] + c * tilt[2], c * edges[2]};
  }
  template <class Visit>
  void for_each_image(const Visit& visit) const {
    for (int c = -images; c <= images; ++c)
      for (int b = -images; b <= images; ++b)
        for (int a = -images; a <= images; ++a) visit(a, b, c);
  }
};

inline const Cell cells[] = {{{1, 1, 1}, {0.5, 0.25, -0.375}, 4}, {{2, 1, 1.5}, {-0.75, 0.5, 0.5}, 5},
                             {{1, 1, 1}, {1, 0, 0}, 5},           {{1, 1, 1}, {2.5, -1.25, 0.75}, 9},
                             {{4, 0.5, 1}, {1.5, -2, 0.125}, 12}, {{1, 2, 0.5}, {0, 0.5, 0}, 8}};

inline Spheres<3> random_spheres(const Cell& cell, std::size_t count, double smallest, double largest,
                                 std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Spheres<3> spheres;
  for (std::size_t i = 0; i < count; ++i)
    spheres.push_back(uniform_point(random, Bounds<3>{Vector<3>::Zero(), cell.edges}),
                      smallest + (largest - smallest) * random.uniform());
  return spheres;
}

}  // namespace bernal::testing::tilted
