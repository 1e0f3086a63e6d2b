#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"

namespace bernal::engine {

/// Where an engine has left the spheres, and its box.
struct Places {
  Spheres<3> spheres;  ///< in the order of the identities, with the radii that are given
  Bounds<3> box;
};

/// One sphere of a dump: the number is its identity less one, and its radius NaN where that is not told.
struct PlacedByEngine {
  std::uint64_t number;
  Vector<3> center;
  double r;
};

/// Reads a dump of one frame with the columns id, x, y, z, and radius where it tells those, and hands on each
/// sphere as it comes, with the box. Every identity from 1 to `count` must be there once, with finite
/// numbers. Throws EngineError with the line that is wrong, or with what is missing. Held is a bit a sphere.
/// Cost: about 0.4 µs a sphere.
void read_places(const std::filesystem::path& file, std::uint64_t count, bool tells_radii,
                 const std::function<void(const Bounds<3>& box, const PlacedByEngine&)>& take);

/// All of them, with these radii.
Places read_places(const std::filesystem::path& file, const std::vector<double>& radii);

}  // namespace bernal::engine
