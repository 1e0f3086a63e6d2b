#pragma once
#include <string>

#include "bernal/viewer/view_page.hpp"

namespace bernal {

/// What src/viewer/page shows of a packing, as JSON that may stand inside a script element: ASCII, without
/// "<". Lengths are those of `frame_of` the domain, (scene - origin) / scale, arrays base64 of little-endian
/// numbers: float32 coordinates (two or three a sphere), float32 radii or one number where all are equal,
/// uint32 indices where spheres are left out, the columns, and the walls. `null` where there is no view.
/// Throws as `view_page` does, but for other dimensions.
std::string view_data(const Packing&, const Measurements* measured, const ViewOptions& = {});

}  // namespace bernal
