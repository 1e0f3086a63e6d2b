#pragma once
#include <filesystem>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"

namespace bernal::engine {

/// Where an engine has left the spheres, and its box.
struct Places {
  Spheres<3> spheres;  ///< in the order of the identities, with the radii that are given
  Bounds<3> box;
};

/// Reads a dump of one frame with the columns id, x, y, z. Every identity from 1 to the number of radii must
/// be there once, with finite coordinates. Throws EngineError with the line that is wrong, or with what
/// is missing. Cost: about 0.4 µs a sphere.
Places read_places(const std::filesystem::path& file, const std::vector<double>& radii);

}  // namespace bernal::engine
