#pragma once
#include <cstdint>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"

namespace bernal {

/// Puts some of the spheres of a periodic box into holes between the others: the largest first, each into the
/// next roomiest of so many random places that none of those before it covers by half; at random where there
/// are no more holes. Room is what is left to the nearest surface, which is a wall on axes that have `walls`.
/// Cost: two random places for each sphere in the box and a thousand more, each about 1 µs in three
/// dimensions.
template <int D>
void move_to_holes(Spheres<D>& spheres, const Vector<D>& edges, std::vector<std::uint32_t> ids,
                   Random& random, const std::vector<bool>& walls = {});

}  // namespace bernal
