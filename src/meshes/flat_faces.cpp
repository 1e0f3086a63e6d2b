// Flat faces of pieces: of caps, and with solids at the ends of periods and where necks begin.
#include <algorithm>
#include <cmath>

#include "meshes/planar_part.hpp"

namespace bernal {

void mesh_flat_faces(SurfaceDraft& draft) { (void)draft; }

}  // namespace bernal
