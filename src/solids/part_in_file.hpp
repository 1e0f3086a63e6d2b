#pragma once
#include <filesystem>

#include "bernal/core/unit.hpp"
#include "solids/convex_part.hpp"

namespace bernal {

/// Whether a name is that of a file of some format that `read_mesh` knows, by its ending.
bool is_file_of_part(const std::filesystem::path&);

/// The convex part that a file holds, of a format that `read_mesh` knows, in this unit: that of its
/// coordinates where it says none. Round faces become flat ones, to within a fiftieth of the radius of the
/// smallest sphere. Throws Error{bad_argument} with one line for a part that is not closed or not convex, and
/// what `read_mesh` throws.
ConvexPart part_in_file(const std::filesystem::path&, Unit, double smallest_radius);

}  // namespace bernal
