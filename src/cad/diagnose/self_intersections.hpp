#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Triangles whose corners lie exactly on a line; predicates are exact.
bool is_degenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle);
std::uint64_t count_degenerate(const Mesh& mesh);

/// Pairs of triangles that meet in more than the vertices and edges that they share by index, in order, and
/// no more than `most_self_intersections`: a mesh of as many is past counting, and past cutting. Predicates
/// are exact, degenerate triangles are left out. Cost: O(T log² T) and the pairs whose boxes overlap; 0.06 µs
/// for each that a plane is proven to part in double precision, 20 µs for each that meets in a plane.
std::vector<std::array<std::uint32_t, 2>> self_intersecting_pairs(const Mesh& mesh);
std::uint64_t count_self_intersections(const Mesh& mesh);
std::uint64_t most_self_intersections(const Mesh& mesh);

/// Whether there is any such pair. Cost: as above, up to the first.
bool intersects_itself(const Mesh& mesh);

}  // namespace bernal::cad
