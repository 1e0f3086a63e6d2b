#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A point and its weight: the power of p is |p - point|² - weight.
struct Site {
  Vector<3> point;
  double weight;
};

/// Whose cells meet in the power diagram of some sites, in one flat list.
struct PowerNeighbours {
  std::vector<std::uint32_t> start;  ///< one more than sites asked for
  std::vector<std::uint32_t> list;
  std::vector<bool> hidden;  ///< whether a site has no cell at all

  std::span<const std::uint32_t> of(std::size_t site) const {
    return {list.data() + start[site], list.data() + start[site + 1]};
  }
};

/// The neighbours of the first `asked` of the sites among all of them: those that an edge of the regular
/// triangulation joins, which is decided exactly. Where more than four cells meet in a point, as in every
/// lattice, some that meet in a corner only are neighbours and some are not. Sites may lie in a plane, in a
/// line or in one place. Cost: about 10 µs and 1 kB a site; wants coordinates near 1.
PowerNeighbours power_neighbours(std::span<const Site> sites, std::size_t asked);

}  // namespace bernal
