#pragma once
#include <string>

#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// Whether the walls are others than the whole surface that stands in the CAD file: parts of it, or what
/// planes, repairs and tessellation made of it.
bool walls_are_made(const Scene& scene);

/// A mesh as OFF, every double to the last bit.
std::string as_off_file(const Mesh& mesh);

}  // namespace bernal
