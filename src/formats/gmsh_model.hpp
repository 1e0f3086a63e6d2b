#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "formats/format.hpp"
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

/// OpenCASCADE takes what is nearer than 1e-7 for one point, in whatever unit, and loses digits in large
/// numbers: a domain whose diagonal is not between 1 and 1000 is built in lengths of its own, ten to this
/// power of the file's unit, in which it is between 10 and 100; its mesh is written in the unit.
int exponent_of_model(const Domain&);
/// The same in those lengths; whatever has no length stays.
Exported in_length_of_model(const Exported&, int exponent);

/// A packing as Gmsh's scripts build it. Volumes are numbered: 1 is the domain, then the pieces and the
/// bridges in their order.
struct GmshModel {
  /// In lengths of ten to the power of `exponent`, see `exponent_of_model`.
  GmshModel(const Exported&, int exponent);

  const Exported& file;
  int exponent;
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

  /// "spheres overlap" or "spheres cross the walls", of which no solids are made one by one; or empty.
  std::string trouble() const;
  /// "1" or "1e-6": of the file's unit.
  std::string length() const { return exponent == 0 ? "1" : "1e" + std::to_string(exponent); }
  /// "m", or "m (built in lengths of 1e-6 m)".
  std::string unit_in_words() const;
  std::size_t first_bridge() const { return 2 + solids.pieces.size(); }
  std::uint32_t type_of(std::size_t piece) const { return file.types[solids.pieces[piece].sphere]; }
  /// "spheres", or "spheres_3" where there are more types than one.
  std::string name_of_type(std::uint32_t type) const;
};

std::string gmsh_geo(const GmshModel&);
std::string gmsh_python(const GmshModel&);

}  // namespace bernal
