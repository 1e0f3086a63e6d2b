#pragma once
#include <filesystem>

#include "bernal/geometry/mesh.hpp"
#include "cad/polygon_soup.hpp"

namespace bernal::cad {

/// Reads a file by the reader of its format. True surfaces, of STEP and the like, are tessellated to within
/// `deflection`, in metres, where a file that does not say its unit has one of `metres`; 0 leaves it to the
/// reader. The attempt is good. Throws Error{bad_mesh} where the file is missing, cannot be parsed, holds no
/// faces or coordinates that are not finite.
ReadAttempt read_soup(const std::filesystem::path& file, double deflection, double metres);

/// The same of a surface that stands in no file; `name` is what errors call it.
ReadAttempt read_surface(const PolygonSurface& surface, const std::filesystem::path& name);

}  // namespace bernal::cad
