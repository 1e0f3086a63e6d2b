#pragma once
#include "scene/entry.hpp"

namespace bernal::schema {

/// Of a CellSizes, and the key of [spheres] that holds one.
const Entry& cells_entry();
Key cells_key();

/// What cells of given volumes demand of the rest of the scene. Throws Error{bad_scene}.
void require_cells(const Scene&);

}  // namespace bernal::schema
