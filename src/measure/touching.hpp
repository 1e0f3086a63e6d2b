#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Two spheres, or a sphere and an image of another one or of itself.
struct NearPair {
  std::uint32_t first, second;
  double gap;  ///< (d - ri - rj) / (ri + rj)
};

/// The same in three dimensions, and where the second lies as seen from the first, in any unit of length.
struct NearBond {
  std::uint32_t first, second;
  Vector<3> displacement;
  double gap;  ///< as NearPair::gap
};

/// The same and nothing else than in which direction, of length 1 to single precision; 0 where the centres
/// coincide.
struct NearDirection {
  std::uint32_t first, second;
  Eigen::Vector3f direction;
};

/// A pair, and of some ascending gaps the place of the first that is above its own.
struct RankedPair {
  std::uint32_t first, second, rank;
};

/// A sphere and a facet, edge or corner of the wall.
struct NearWall {
  std::uint32_t sphere;
  double gap;  ///< (clearance - r) / r
};

/// Everything whose gap ratio is below `widest_gap`, each once, in an order that does not depend on the
/// number of threads. Cost: O(N + pairs).
std::vector<NearPair> near_pairs(const Spheres<dynamic>&, const Domain&, double widest_gap);
/// All whose gap ratio is below the last of these gaps, which ascend, in parts of some thousand: 12 bytes a
/// pair and nothing beside them.
std::vector<std::vector<RankedPair>> ranked_pairs(const Spheres<dynamic>&, const Domain&,
                                                  std::span<const double> gaps);
/// The same pairs in the same order. Precondition: three dimensions.
std::vector<NearBond> near_bonds(const Spheres<dynamic>&, const Domain&, double widest_gap);

/// The bonds of some spheres in the middle, and of their neighbours, in parts of some thousand spheres: 20
/// bytes a bond and nothing beside them.
struct BondsInside {
  std::vector<std::uint32_t> ids;  ///< of those that bonds number; empty: all, as they are
  std::size_t asked = 0;  ///< so many of them, the first, have all their bonds, and their neighbours too
  std::vector<std::vector<NearDirection>> bonds;
};
/// Of all spheres, or of so many where there are more. Precondition: three dimensions.
BondsInside near_directions_inside(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                   std::size_t most);
/// `near_pairs`, of more spheres than so many only those of some in the middle.
std::vector<NearPair> near_pairs_inside(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                        std::size_t most);
/// Nothing where there are no walls.
std::vector<NearWall> near_walls(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                 const std::shared_ptr<const Container>& made);

}  // namespace bernal
