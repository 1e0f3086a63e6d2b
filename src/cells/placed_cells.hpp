#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/measure/cells.hpp"

namespace bernal {

/// Cells as files hold them, each whole about its sphere: what sticks out of the period has corners, edges
/// and faces there which are images of others.
struct PlacedCells {
  /// Which other one it is an image of, if that is not itself, and moved by how many periods from there.
  struct Origin {
    std::uint32_t first = 0;
    Cells::Image image = {};
  };
  struct Face {
    std::uint32_t face = 0;                 ///< of the cells
    std::uint32_t cell = 0;                 ///< from which it is seen
    std::uint32_t other = Cells::none;      ///< the cell behind it, if that has the same placed face
    Origin origin = {};                     ///< seen from the other side than this where it is an image
    std::vector<std::uint32_t> nodes = {};  ///< anticlockwise seen from outside the cell
    std::vector<std::int64_t> edges = {};   ///< from each node to the next: number + 1, negative backwards
  };
  struct Edge {
    std::uint32_t from = 0, to = 0;
    Origin origin = {};
    bool is_backwards = false;  ///< of the edge that it is an image of
  };

  std::vector<Vector<3>> nodes;
  std::vector<Cells::Corner> corner_of_node;
  std::vector<Origin> origin_of_node;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  /// Of every cell its faces: number + 1, negative where the face is seen from the other cell.
  std::vector<std::vector<std::int64_t>> faces_of_cell;
};

/// Cost: some µs a cell. In two dimensions faces are sides with two nodes, and edges are those.
PlacedCells placed(const Cells&);

}  // namespace bernal
