#pragma once
#include <cstdint>
#include <string>

// Beds in random vessels: whatever the seed, every sphere rests.
namespace bernal::hard {

/// Settles a bed of some to some hundred spheres in the vessel of each of so many seeds: tins, boxes and
/// balls, upright and leaning, hoppers and flasks of triangles, with pipes through them; equal sizes, sizes
/// up to 1 : 3; by a count, a height, a heap, or to the brim. Says which do not rest by `measure_rest`,
/// overlap by brute force, or end at a limit, a line each.
std::string objections_to_beds(std::uint64_t first_seed, std::uint64_t seeds);

}  // namespace bernal::hard
