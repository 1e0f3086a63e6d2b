#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Triangles whose corners lie exactly on a line; predicates are exact.
bool is_degenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);
std::uint64_t count_degenerate(const Mesh& mesh);

/// Pairs of triangles that meet in more than the vertices and edges that they share by index; predicates are
/// exact, degenerate triangles are left out. Cost: O(T log² T) and the pairs whose boxes overlap.
std::uint64_t count_self_intersections(const Mesh& mesh);

/// The same pairs, in order.
std::vector<std::array<std::uint32_t, 2>> self_intersecting_pairs(const Mesh& mesh);

}  // namespace bernal::cad
