#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "bernal/scene/sizes.hpp"

namespace bernal {

/// What fills a layer of spheres: the packing of another scene, whose container is the ball that the layer
/// is. It has to be the innermost one.
struct Inside {
  std::filesystem::path scene =
      {};                     ///< of what lies inside, relative to the folder of the scene that names it
  std::string of_class = {};  ///< may be empty where there is only one
  std::string layer = {};     ///< may be empty where spheres have no layers: the sphere itself
  /// So many packings, each of which fills many spheres, turned at random; without, every sphere has its own.
  std::optional<int> templates = {};
  Locations locations = {};
};

}  // namespace bernal
