#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "export/format.hpp"
#include "solids/flat_faces.hpp"
#include "solids/narrow_places.hpp"

namespace bernal {

/// A turn about an axis through a sphere's centre that brings its seam to a better place, see `Seam`.
struct Turn {
  Vector<3> axis = Vector<3>::UnitZ();
  double angle = 0;
};

/// What takes a cap off a sphere: a cylinder on the plane of the cut, wide and high enough for the cap.
struct CapTool {
  Vector<3> base, axis;
  double radius;
};

/// A packing as Gmsh's scripts build it. Volumes are numbered: 1 is the domain, then the pieces and the
/// bridges in their order.
struct GmshModel {
  explicit GmshModel(const Exported&);

  const Exported& file;
  const Solids& solids;
  std::vector<Turn> turns;                 ///< one a piece
  std::vector<std::vector<CapTool>> caps;  ///< one list a piece
  std::vector<std::size_t> cut_pieces;     ///< those that an end of a period cuts
  std::vector<std::size_t> cut_bridges;
  std::vector<FlatFace> faces;  ///< of a mesh
  std::vector<NarrowPlace> places;
  Bounds<3> bounds;
  std::array<bool, 3> periods;
  double largest_size = 0;  ///< of elements

  std::size_t first_bridge() const { return 2 + solids.pieces.size(); }
  std::uint32_t type_of(std::size_t piece) const { return file.types[solids.pieces[piece].sphere]; }
  /// "spheres", or "spheres_3" where there are more types than one.
  std::string name_of_type(std::uint32_t type) const;
};

std::string gmsh_geo(const GmshModel&);
std::string gmsh_python(const GmshModel&);

}  // namespace bernal
