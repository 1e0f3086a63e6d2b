#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Whether the corners are exactly collinear.
bool is_degenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);
std::uint64_t count_degenerate(const Mesh& mesh);

/// Pairs of triangles that meet in more than their common vertices and edges, in order, at most
/// `most_self_intersections`: beyond that counting and cutting are pointless. Predicates are exact;
/// degenerate triangles are ignored. Cost: O(T log² T), 0.06 µs for each pair with overlapping boxes that a
/// plane separates in double precision, 20 µs for each coplanar pair that meets.
std::vector<std::array<std::uint32_t, 2>> self_intersecting_pairs(const Mesh& mesh);
std::uint64_t count_self_intersections(const Mesh& mesh);
std::uint64_t most_self_intersections(const Mesh& mesh);

/// Whether there is such a pair. Cost: as above, up to the first.
bool intersects_itself(const Mesh& mesh);

}  // namespace bernal::cad
