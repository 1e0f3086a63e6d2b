#pragma once
#include <filesystem>

#include "bernal/geometry/mesh.hpp"
#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

/// Reads a file with the reader of its format. True surfaces (STEP and the like) are tessellated to within
/// `deflection`, in metres, with `metres` as the unit of a file that states none; 0 leaves it to the reader.
/// With `inside`, in metres, see `read_with_opencascade`. The attempt succeeded. Throws Error{bad_mesh} if
/// the file is missing, cannot be parsed, has no faces or has coordinates that are not finite; OptionError
/// where an option of the scene is why it is not read.
ReadAttempt read_soup(const std::filesystem::path& file, double deflection, double metres,
                      const std::optional<SpheresInside>& inside = {});

/// The same for a surface that stands in no file; `name` is what errors call it.
ReadAttempt read_surface(const PolygonSurface& surface, const std::filesystem::path& name);

}  // namespace bernal::cad
