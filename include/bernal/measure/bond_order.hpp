#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bernal/measure/wall_profile.hpp"

namespace bernal {

/// How much of a packing is crystal, told from the directions in which each sphere has its neighbours.
///
/// *Neighbours* are spheres nearer than |ci - cj| < (1 + widest_gap) (ri + rj), which depends on surfaces and
/// so is fair to any sizes. The spherical harmonics of degree 6 of a sphere's bonds to them, summed, are a
/// vector of 13 components; q(i) is that vector at unit length. A bond is *solid-like* where
///   q(i)·q(j) > solid_bond,
/// that is, where the surroundings of both look alike and lie alike, and a sphere is *crystalline* where at
/// least `fewest_solid` of its bonds, and at least the share `solid_share` of them, are.
///
/// A sphere at a wall lacks the neighbours of one side. The usual count of seven solid-like bonds would not
/// see that a wall has ordered it: in a hexagonal layer six of them lie in the plane. Hence a lower count,
/// and the share, which keeps out dense surroundings that are merely random.
struct BondOrder {
  struct Count {
    std::uint64_t spheres = 0;
    std::uint64_t crystalline = 0;
    double fraction() const {
      return spheres > 0 ? static_cast<double>(crystalline) / static_cast<double>(spheres) : 0;
    }
  };
  Count all;
  /// Mean over the spheres that have neighbours of Steinhardt's q6, the length of the sum above divided by
  /// the number of bonds: 0.5745 in fcc, 0.4848 in hcp, the smaller the more bonds point in all directions.
  double mean_q6 = 0;
  double q6_error = 0;             ///< standard error of that mean, as if spheres were independent
  std::optional<Count> near_wall;  ///< by Region, where there are walls
  std::optional<Count> core;

  static constexpr double widest_gap = 0.3;
  static constexpr double solid_bond = 0.7;
  static constexpr std::uint32_t fewest_solid = 5;
  static constexpr double solid_share = 0.6;
  /// Of more spheres than `most_spheres` those in the middle are looked at, `looked_at` of them:
  /// `all.spheres` says how many.
  static constexpr std::size_t most_spheres = 4'000'000, looked_at = 1'000'000;
};

/// Absent in other dimensions than three. `regions` are those of a wall profile, or empty. Cost: O(N bonds),
/// about 2 µs a sphere, and 260 bytes. Random close packings of equal spheres have up to about 1 %, fcc and
/// hcp 100 %. Source: Steinhardt, Nelson & Ronchetti, Phys. Rev. B 28 (1983) 784; ten Wolde, Ruiz-Montero &
/// Frenkel, J. Chem. Phys. 104 (1996) 9932, who compare neighbours; the limit 0.7 for hard spheres is that of
/// Filion, Hermes, Ni & Dijkstra, J. Chem. Phys. 133 (2010) 244115.
std::optional<BondOrder> bond_order(const Spheres<dynamic>&, const Domain&,
                                    std::span<const Region> regions = {});

}  // namespace bernal
