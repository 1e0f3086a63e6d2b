#pragma once
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// "from 10 to 40 mm along (0, 0, 1)"
std::string slab_text(const Packing&, const Slab&);
/// "; of the bed below 24.1 mm", "; of the slab from …"; nothing where all is measured.
std::string part_text(const Packing&, const Measurements&);

/// What `bernal measure` says of the walls taken together, and along and around the axis of a column.
void print_walls(const Packing&, const Measurements&);
void print_column(const Packing&, const Measurements&);

}  // namespace bernal
