#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

// The walls of a container as programs of particle transport know them: surfaces of first and second order,
// and parts of space that are on one side of each of several.

struct LevelSurface {
  enum class Kind { plane, sphere, cylinder, cone };

  Kind kind = Kind::plane;
  Vector<3> at = Vector<3>::Zero();     ///< centre of a sphere, a point of an axis, apex of a cone
  Vector<3> axis = Vector<3>::UnitZ();  ///< of unit length; of a plane the normal
  double size = 0;  ///< the radius; of a plane n·p on it; of a cone the growth of its radius along the axis

  /// The coordinate axis that `axis` lies along, in either sense, or -1.
  int coordinate_axis() const;
  /// A … J of A x² + B y² + C z² + D xy + E yz + F xz + G x + H y + I z + J, which is negative inside, or
  /// where n·p is smaller.
  std::array<double, 10> quadric() const;
};

/// One side of a surface: where its formula is negative, or where it is positive.
struct SurfaceSide {
  std::size_t surface = 0;
  bool inner = true;
};
using CommonPart = std::vector<SurfaceSide>;

struct LevelWalls {
  std::vector<LevelSurface> surfaces;
  std::vector<CommonPart>
      inside;  ///< parts without a common point but on their surfaces; together the domain
  std::vector<CommonPart> outside;  ///< the same of the rest of space
  /// Of surfaces: whether it is an end of a period.
  std::vector<bool> periodic;
  std::string words;  ///< "box", "cylinder", …
};

/// Precondition: no mesh and no polygon. A solid of revolution is cut at the heights of all corners of its
/// profile. Cost: O(n²) for n corners.
LevelWalls walls_of(const Domain&);

}  // namespace bernal
