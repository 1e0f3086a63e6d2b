#pragma once
#include <string>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// A surface after a requested repair. Repairs never throw because of the surface: `done` says in one phrase
/// what succeeded and what did not, and the mesh is the result so far.
struct RepairedMesh {
  Mesh mesh;
  std::string done;
};

}  // namespace bernal::cad
