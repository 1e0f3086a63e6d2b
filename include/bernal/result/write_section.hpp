#pragma once
#include <filesystem>
#include <string_view>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// Writes the picture of the section along `plane`, "z = 1.5", into a file, or leaves what stands there as it
/// is. Throws Error{bad_argument} for no plane, one that misses the domain, other dimensions than three or a
/// file that does not end in .svg, and Error{cannot_write}, as where the file belongs to a result.
void write_section(const Packing&, std::string_view plane, const std::filesystem::path& file);

}  // namespace bernal
