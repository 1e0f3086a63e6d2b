#pragma once
#include <Eigen/Geometry>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

/// Meshes stored once in a file with any number of placements, possibly nested: 3MF and AMF.
struct PlacedMeshes {
  /// Triangles of one part, indexing the points of its object.
  struct Piece {
    std::string name;
    std::vector<std::array<std::uint32_t, 3>> triangles = {};
  };
  struct Component {
    std::string object;  ///< its key
    Eigen::Affine3d placement = Eigen::Affine3d::Identity();
  };
  struct Object {
    std::string name;
    std::vector<Vector<3>> points = {};
    std::vector<Piece> pieces = {};
    std::vector<Component> components = {};
  };

  std::map<std::string, Object> objects;  ///< by key; every referenced object is present
  std::vector<Component> items;           ///< what the file builds
};

/// Appends everything that the items place, one solid a piece, named after the piece or the nearest enclosing
/// object with a name. Mirrored faces are flipped; flattened pieces are left out with a note. Throws
/// Error{bad_mesh} if an object contains itself or is nested more than a thousand deep, or for more than 1e9
/// faces or 1e7 pieces in all.
void append_placed(const PlacedMeshes&, ReadAttempt&);

}  // namespace bernal::cad
