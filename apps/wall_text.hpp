#pragma once
#include <optional>
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// "; of the bed below 24.1 mm"; nothing without a level.
std::string part_of_bed(const Packing&, const std::optional<BedProfile>&);

/// What `bernal measure` says of the walls taken together, and along and around the axis of a column.
void print_walls(const Packing&, const Measurements&);
void print_column(const Packing&, const ColumnProfile&);

}  // namespace bernal
