#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// A ball cut by planes: points with normal·p <= offset are kept.
struct BallShape {
  struct Plane {
    Vector<3> normal;
    double offset;
  };
  Vector<3> center;
  double radius;
  Vector<3> pole, meridian;  ///< perpendicular unit vectors; the start of the surface's parameters
  std::vector<Plane> cuts;
  std::uint32_t type;  ///< from 1
  double hole = 0;     ///< the radius of a ball of the same centre that is taken out; 0: none
};

/// A cylinder minus the two balls whose circles it ends in.
struct NeckShape {
  std::array<Vector<3>, 2> rims;
  double radius;
  std::array<double, 2> radii;  ///< of the balls
  std::vector<BallShape::Plane> cuts;
};

/// Solids for CAD files, in the unit of the file, as plain data.
struct SolidShapes {
  std::vector<BallShape> balls;
  std::vector<NeckShape> necks;
  std::vector<std::string> type_names;
  Domain domain;
  /// For a mesh: polygons with holes, as corners; if empty, no container is written.
  std::vector<std::vector<std::vector<std::uint32_t>>> faces;
};

enum class SolidFormat : std::uint8_t { step, brep };

/// The result of `write_with_opencascade`.
struct WrittenShapes {
  std::string failure;       ///< empty: the file was written
  std::uint64_t solids = 0;  ///< not counting the container
  double volume = 0;         ///< total volume of these, by OpenCASCADE
  bool has_container = false;
};

/// Writes solids through OpenCASCADE, in a child process: STEP in millimetres, with one product a type,
/// "bridges" and "container", each with its own colour; BREP as one compound. Throws Error{cannot_write} with
/// the reason, Cancelled. Cost: about 2 ms a whole sphere, 20 ms a cut one.
WrittenShapes write_with_opencascade(const SolidShapes&, SolidFormat, const std::filesystem::path& file);

}  // namespace bernal::cad

/// Entry point of the OpenCASCADE module.
extern "C" void bernal_write_shapes(const bernal::cad::SolidShapes& shapes, bernal::cad::SolidFormat format,
                                    const std::filesystem::path& file, bernal::cad::WrittenShapes& result);
