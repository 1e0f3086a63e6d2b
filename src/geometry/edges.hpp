#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Instead of the number of a triangle, a vertex or a piece.
inline constexpr std::uint32_t no_index = 0xFFFFFFFF;

/// A triangle at an edge.
struct EdgeUse {
  std::uint32_t low, high;  ///< the ends of the edge, low <= high
  std::uint32_t triangle;
  std::uint8_t side;  ///< the edge runs from this corner of the triangle to the next
  bool upwards;       ///< it runs from low to high in the triangle

  bool is_of_edge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// The edges of triangles, each with its triangles, in one array sorted by the ends of the edges and then by
/// triangle. Cost: O(T log T), 48 bytes a triangle.
class MeshEdges {
 public:
  explicit MeshEdges(std::span<const FaceCorners> triangles);

  /// Calls see(std::span<const EdgeUse>) for every edge.
  template <class See>
  void for_each(const See& see) const {
    for (auto first = uses_.begin(); first != uses_.end();) {
      const auto last =
          std::find_if(first, uses_.end(), [&](const EdgeUse& use) { return !use.is_of_edge(*first); });
      see(std::span<const EdgeUse>(first, last));
      first = last;
    }
  }

  /// Number of triangles with the edge between two vertices. Cost: O(log T).
  std::size_t triangles_at(std::uint32_t a, std::uint32_t b) const;

 private:
  std::vector<EdgeUse> uses_;
};

/// The edges with one triangle, in the order of their triangles. Cost: O(T log T).
std::vector<EdgeUse> open_edges(std::span<const FaceCorners> triangles);

using SharpEdges = std::vector<std::array<std::uint32_t, 2>>;

/// The edges that show a shape, sorted by their ends: those with other than two triangles, those that bend by
/// more than 30 degrees, and those whose two unit normals satisfy `also`; if more than `most`, only the
/// longest. A triangle without area does not bend an edge. Cost: O(T log T).
SharpEdges sharp_edges(const Mesh&, std::size_t most,
                       const std::function<bool(const Vector<3>&, const Vector<3>&)>& also = {});

}  // namespace bernal
