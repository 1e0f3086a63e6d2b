#pragma once
#include <string>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// A surface after a repair that somebody asked for. Repairs never throw for what a surface is like: `done`
/// says in one phrase what was done and what was not, and the mesh is then as far as it got.
struct RepairedMesh {
  Mesh mesh;
  std::string done;
};

}  // namespace bernal::cad
