#pragma once
#include <string>

#include "bernal/viewer/view_page.hpp"

namespace bernal {

/// The data of src/viewer/page for a packing, as JSON that is safe inside a script element: ASCII, without
/// "<". Lengths are in the frame `frame_of` the domain, (scene - origin) / scale; arrays are base64 of
/// little-endian numbers: float32 coordinates (two or three a sphere), float32 radii or one number if all are
/// equal, uint32 indices if spheres are left out, the columns, and the walls. `null` in dimensions without a
/// view. Otherwise throws as `view_page` does.
std::string view_data(const Packing&, const Measurements* measured, const ViewOptions& = {});

}  // namespace bernal
