#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Two spheres, or a sphere and an image of another or of itself.
struct NearPair {
  std::uint32_t first, second;
  double gap;  ///< (d - ri - rj) / (ri + rj)
};

/// A pair, with the displacement to the second, in any unit of length.
template <int D>
struct BondIn {
  std::uint32_t first, second;
  Vector<D> displacement;
  double gap;  ///< as NearPair::gap
};
using NearBond = BondIn<3>;

/// A pair and its direction only, a unit vector in single precision; 0 if the centres coincide.
struct NearDirection {
  std::uint32_t first, second;
  Eigen::Vector3f direction;
};

/// A pair, and the index of the first of some ascending gaps that is above its own.
struct RankedPair {
  std::uint32_t first, second, rank;
};

/// A sphere and a facet, edge or corner of the wall.
struct NearWall {
  std::uint32_t sphere;
  double gap;  ///< (clearance - r) / r
};
/// The same, with the direction to the wall's point.
struct WallBond {
  std::uint32_t sphere;
  Vector<dynamic> outward;  ///< of unit length
  double gap;
};

/// What pairs add up to: how many each sphere has, with a pair of a sphere and its own image counted twice,
/// and the sum over all pairs of n n^T, where n is the unit vector between the centres, 0 if these coincide.
struct BondSums {
  std::vector<std::uint32_t> ends;
  Eigen::MatrixXd products;
  std::uint64_t pairs = 0;
};

/// All pairs with a gap ratio below `widest_gap`, each once, in an order independent of the number of
/// threads. Cost: O(N + pairs).
std::vector<NearPair> near_pairs(const Spheres<dynamic>&, const Domain&, double widest_gap);
/// All pairs with a gap ratio below the last of these ascending gaps, in parts of some thousand pairs: 12
/// bytes a pair and no more.
std::vector<std::vector<RankedPair>> ranked_pairs(const Spheres<dynamic>&, const Domain&,
                                                  std::span<const double> gaps);
/// The same pairs in the same order. Precondition: D dimensions.
template <int D>
std::vector<BondIn<D>> bonds_in(const Spheres<dynamic>&, const Domain&, double widest_gap);
/// Of the same pairs; nothing is kept of each of them.
BondSums bond_sums(const Spheres<dynamic>&, const Domain&, double widest_gap);
/// `bonds_in` three dimensions.
std::vector<NearBond> near_bonds(const Spheres<dynamic>&, const Domain&, double widest_gap);

/// The bonds of some spheres in the middle and of their neighbours, in parts of some thousand spheres: 20
/// bytes a bond and no more.
struct BondsInside {
  std::vector<std::uint32_t> ids;  ///< indices of the spheres that bonds refer to; empty: all
  std::size_t asked = 0;           ///< the first `asked` of them, and their neighbours, have all their bonds
  std::vector<std::vector<NearDirection>> bonds;
};
/// For all spheres, or for `most` of them if there are more. Precondition: three dimensions.
BondsInside near_directions_inside(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                   std::size_t most);
/// `near_pairs`, but for more than `most` spheres only those of some in the middle.
std::vector<NearPair> near_pairs_inside(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                        std::size_t most);
/// Empty without walls.
std::vector<NearWall> near_walls(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                 const std::shared_ptr<const Container>& made);
/// The same in the same order.
std::vector<WallBond> wall_bonds(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                 const std::shared_ptr<const Container>& made);

}  // namespace bernal
