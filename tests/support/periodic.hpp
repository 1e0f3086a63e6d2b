#pragma once
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/random.hpp"
#include "bernal/scene/packing.hpp"
#include "bernal/scene/read_scene.hpp"

namespace bernal::testing {

/// Spheres in a periodic box as `run` would return them; `sizes` is what the scene asks for.
template <int D>
Packing periodic_packing(Spheres<D> spheres, const Vector<D>& edges,
                         const std::string& sizes = "radius = 1.0") {
  Packing packing;
  packing.spheres = std::move(spheres);
  packing.domain = bernal::periodic_box(edges);
  packing.volume = volume_of(packing.domain);
  packing.scene =
      parse_scene(fmt::format("unit = \"mm\"\n[container]\nkind = \"periodic\"\ndimension = {}\nsize = [{}]\n"
                              "[spheres]\nfill = true\n{}\n",
                              D, fmt::join(edges, ", "), sizes),
                  "test.toml");
  packing.program.version = "0.0.0";
  packing.reason = "made by hand";
  return packing;
}

/// Points uniform in [0, edge) with radii between r_min and r_max: an ideal gas, which overlaps.
template <int D>
Spheres<D> ideal_gas(std::size_t n, double r_min, double r_max, const Vector<D>& edges, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Spheres<D> spheres;
  for (std::size_t i = 0; i < n; ++i) {
    const Vector<D> c = uniform_point(random, Bounds<D>{Vector<D>::Zero(), edges});
    spheres.push_back(c, random.uniform(r_min, r_max));
  }
  return spheres;
}

/// cells[k] repetitions of a box with these edges on axis k, with spheres of radius r at `sites`, given in
/// edges.
template <int D>
Packing lattice(const std::vector<Vector<D>>& sites, const Vector<D>& edges, const std::array<int, D>& cells,
                double r) {
  Spheres<D> spheres;
  std::array<int, D> at{};
  for (int k = 0; k < D;) {
    Vector<D> corner;
    for (int axis = 0; axis < D; ++axis) corner[axis] = at[axis];
    for (const Vector<D>& site : sites) spheres.push_back((corner + site).cwiseProduct(edges), r);
    for (k = 0; k < D && ++at[k] == cells[k]; ++k) at[k] = 0;
  }
  Vector<D> size = edges;
  for (int k = 0; k < D; ++k) size[k] *= cells[k];
  return periodic_packing<D>(std::move(spheres), size, fmt::format("radius = {}", r));
}

/// Lattices of touching spheres of diameter 1; n cells on every axis.
inline Packing simple_cubic(int n) { return lattice<3>({{0, 0, 0}}, Vector<3>::Ones(), {n, n, n}, 0.5); }
inline Packing body_centred(int n) {
  return lattice<3>({{0, 0, 0}, {.5, .5, .5}}, Vector<3>::Constant(2 / std::sqrt(3.0)), {n, n, n}, 0.5);
}
inline Packing face_centred(int n) {
  return lattice<3>({{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}}, Vector<3>::Constant(std::sqrt(2.0)),
                    {n, n, n}, 0.5);
}
inline Packing hexagonal_discs(int n) {
  return lattice<2>({{0, 0}, {.5, .5}}, Vector<2>(1, std::sqrt(3.0)), {2 * n, n}, 0.5);
}

}  // namespace bernal::testing
