#pragma once
#include <cstdint>
#include <memory>
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

/// A sphere and a facet, edge or corner of the wall.
struct NearWall {
  std::uint32_t sphere;
  double gap;  ///< (clearance - r) / r
};

/// Everything whose gap ratio is below `widest_gap`, each once, in an order that does not depend on the
/// number of threads. Cost: O(N + pairs).
std::vector<NearPair> near_pairs(const Spheres<dynamic>&, const Domain&, double widest_gap);
/// The same pairs in the same order. Precondition: three dimensions.
std::vector<NearBond> near_bonds(const Spheres<dynamic>&, const Domain&, double widest_gap);
/// Nothing where there are no walls.
std::vector<NearWall> near_walls(const Spheres<dynamic>&, const Domain&, double widest_gap,
                                 const std::shared_ptr<const Container>& made);

}  // namespace bernal
