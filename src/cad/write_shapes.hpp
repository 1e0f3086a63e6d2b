#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// A ball less what lies beyond planes: points with normal·p <= offset are kept.
struct BallShape {
  struct Plane {
    Vector<3> normal;
    double offset;
  };
  Vector<3> center;
  double radius;
  Vector<3> pole, meridian;  ///< where the surface begins: perpendicular units
  std::vector<Plane> cuts;
  std::uint32_t type;  ///< from 1
};

/// A cylinder less the two balls whose circles it ends in.
struct NeckShape {
  std::array<Vector<3>, 2> rims;
  double radius;
  std::array<double, 2> radii;  ///< of the balls
  std::vector<BallShape::Plane> cuts;
};

/// Solids as CAD files hold them, in the unit of the file, all as plain data.
struct SolidShapes {
  std::vector<BallShape> balls;
  std::vector<NeckShape> necks;
  std::vector<std::string> type_names;
  Domain domain;
  /// Of a mesh: polygons with holes, as corners; empty: no container is written.
  std::vector<std::vector<std::vector<std::uint32_t>>> faces;
};

enum class SolidFormat : std::uint8_t { step, brep };

/// What came of it.
struct WrittenShapes {
  std::string failure;       ///< empty: the file is there
  std::uint64_t solids = 0;  ///< without the container
  double volume = 0;         ///< of these, by OpenCASCADE
  bool has_container = false;
};

/// Writes solids through OpenCASCADE, in a child process: STEP in millimetres, with a product a type,
/// "bridges" and "container", each of a colour of its own; BREP as one compound. Throws Error{cannot_write}
/// with what is missing or went wrong, Cancelled. Cost: about 2 ms a whole sphere, 20 ms one that is cut.
WrittenShapes write_with_opencascade(const SolidShapes&, SolidFormat, const std::filesystem::path& file);

}  // namespace bernal::cad

/// What the module of OpenCASCADE answers.
extern "C" void bernal_write_shapes(const bernal::cad::SolidShapes& shapes, bernal::cad::SolidFormat format,
                                    const std::filesystem::path& file, bernal::cad::WrittenShapes& result);
