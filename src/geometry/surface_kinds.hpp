#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "bernal/geometry/true_surface.hpp"

namespace bernal {

/// The faces of one kind.
struct SurfaceKind {
  std::string name;  ///< "plane"
  std::size_t faces = 0;
  double share = 0;  ///< of the area of the triangles
};

/// By their area, the largest first.
std::vector<SurfaceKind> kinds_of(const TrueSurface&);

}  // namespace bernal
