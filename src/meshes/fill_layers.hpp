#pragma once
#include "meshes/fill.hpp"

namespace bernal {

/// As `fill`, with the prisms of thin layers that come with the surface: TetGen fills what is around and
/// within them. Checked in the same way, for all regions.
VolumeMesh fill_with_layers(const ConformingSurface&, const TetrahedraOptions&, FillReport&,
                            const Monitor& monitor = {});

}  // namespace bernal
