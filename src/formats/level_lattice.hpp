#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/levels.hpp"

namespace bernal {

/// A grid over a level that says which spheres reach into each of its elements, so that a program that tracks
/// particles looks at few of them. Elements are counted x fastest, then y, then z.
struct LevelLattice {
  std::array<std::size_t, 3> shape = {1, 1, 1};
  Vector<3> lower, pitch;
  std::vector<std::uint32_t> first;    ///< one entry an element, and one more
  std::vector<std::uint32_t> spheres;  ///< of all elements, ascending in each

  std::size_t size() const { return shape[0] * shape[1] * shape[2]; }
  std::span<const std::uint32_t> of(std::size_t element) const {
    return {spheres.data() + first[element], spheres.data() + first[element + 1]};
  }
  Vector<3> center(std::size_t element) const;
};

/// Whether the level has more spheres than a program should look at one after the other.
bool needs_lattice(const Level&);

/// About eight centres lie in each element. A sphere counts for an element that it touches to rounding. Cost:
/// O(N).
LevelLattice lattice_of(const Level&);

}  // namespace bernal
