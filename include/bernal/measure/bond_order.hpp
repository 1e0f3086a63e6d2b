#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bernal/measure/wall_profile.hpp"

namespace bernal {

/// How much of a packing is crystalline, from the directions of each sphere's bonds.
///
/// *Neighbours* are spheres nearer than |ci - cj| < (1 + widest_gap) (ri + rj); the limit depends on
/// surfaces, so it holds for any sizes. The spherical harmonics of degree 6 of a sphere's bonds, summed, form
/// a vector of 13 components; q(i) is its unit vector. A bond is *solid-like* if
///   q(i)·q(j) > solid_bond,
/// that is, if both surroundings have the same shape and orientation. A sphere is *crystalline* if at least
/// `fewest_solid` of its bonds, and at least the share `solid_share` of them, are solid-like.
///
/// A sphere at a wall has no neighbours on one side. The usual limit of seven solid-like bonds would miss
/// order at a wall: in a hexagonal layer six of them lie in the plane. Hence the lower count; the share
/// excludes dense random surroundings.
struct BondOrder {
  struct Count {
    std::uint64_t spheres = 0;
    std::uint64_t crystalline = 0;
    double fraction() const {
      return spheres > 0 ? static_cast<double>(crystalline) / static_cast<double>(spheres) : 0;
    }
  };
  Count all;
  /// Mean of Steinhardt's q6 over the spheres with neighbours: the length of the sum above over the number of
  /// bonds. 0.5745 in fcc, 0.4848 in hcp; it falls as bonds spread over all directions.
  double mean_q6 = 0;
  double q6_error = 0;             ///< standard error of that mean for independent spheres
  std::optional<Count> near_wall;  ///< by Region, if there are walls
  std::optional<Count> core;

  static constexpr double widest_gap = 0.3;
  static constexpr double solid_bond = 0.7;
  static constexpr std::uint32_t fewest_solid = 5;
  static constexpr double solid_share = 0.6;
  /// In a packing of more than `most_spheres`, only the `looked_at` in the middle are evaluated;
  /// `all.spheres` is their number.
  static constexpr std::size_t most_spheres = 4'000'000, looked_at = 1'000'000;
};

/// Absent in other than three dimensions. `regions` are those of a wall profile, or empty. Cost: O(N bonds),
/// about 2 µs and 260 bytes a sphere. Random close packings of equal spheres have up to about 1 % crystalline
/// spheres, fcc and hcp 100 %. Source: Steinhardt, Nelson & Ronchetti, Phys. Rev. B 28 (1983) 784; ten Wolde,
/// Ruiz-Montero & Frenkel, J. Chem. Phys. 104 (1996) 9932, who compare neighbours; the limit 0.7 for hard
/// spheres is that of Filion, Hermes, Ni & Dijkstra, J. Chem. Phys. 133 (2010) 244115.
std::optional<BondOrder> bond_order(const Spheres<dynamic>&, const Domain&,
                                    std::span<const Region> regions = {});

}  // namespace bernal
