#pragma once
#include <Eigen/Geometry>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

/// Meshes that a file holds once, and where it places them, as often as it likes, one within the other: 3MF
/// and AMF.
struct PlacedMeshes {
  /// Triangles of one part, in the points of its object.
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

  std::map<std::string, Object> objects;  ///< by key; all that are named are here
  std::vector<Component> items;           ///< what is there in the end
};

/// Appends all that the items place, a solid a piece, named after the piece, else the nearest object around
/// it that has a name. A placement that mirrors turns faces round; what one flattens is left out, and said.
/// Throws Error{bad_mesh} where an object is a part of itself or nested more than a thousand deep, or where
/// all together are more than 1e9 faces or 1e7 pieces.
void append_placed(const PlacedMeshes&, ReadAttempt&);

}  // namespace bernal::cad
