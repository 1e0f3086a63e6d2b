#pragma once
#include <cstdint>
#include <vector>

#include "cad/triangle_tree.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {

/// The pieces of a closed surface and their nesting. The mesh must outlive it.
class SurfacePieces {
 public:
  /// Throws Error{bad_mesh} for more than 2,000 pieces. Cost: a tree query for every two pieces.
  explicit SurfacePieces(const Mesh& mesh);

  std::uint32_t count() const { return topology_.components; }
  std::uint32_t piece_of(std::size_t triangle) const { return topology_.component[triangle]; }
  /// Number of pieces that enclose it: the walls of a space are a piece of even depth and those next inside
  /// it.
  std::uint32_t depth(std::uint32_t piece) const { return depth_[piece]; }
  /// One corner of it.
  const Vector<3>& corner(std::uint32_t piece) const { return mesh_.vertices[corner_[piece]]; }
  /// Volume enclosed by each piece.
  std::vector<double> volumes() const;

  bool encloses(std::uint32_t piece, const Vector<3>& p) const;
  bool encloses(std::uint32_t piece, std::uint32_t other) const {
    return piece != other && encloses(piece, corner(other));
  }
  /// The innermost piece around a point; no_index if none.
  std::uint32_t around(const Vector<3>& p) const;

  /// The walls of the spaces with these outermost pieces: they and the pieces next inside them.
  Mesh walls_of(const std::vector<bool>& outermost) const;

 private:
  const Mesh& mesh_;
  MeshTopology topology_;
  TriangleTree tree_;
  std::vector<std::uint32_t> corner_, depth_;
};

}  // namespace bernal::cad
