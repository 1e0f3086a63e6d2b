#pragma once
#include <filesystem>

#include "bernal/measure/local_packing.hpp"
#include "bernal/scene/packing.hpp"

namespace bernal {

/// The local packing fraction of every sphere as a CSV file, in the order of spheres.csv: after "# unit: mm"
/// and a header the columns packing_fraction, cell_volume (in that unit to the power of the dimension) and
/// neighbours. Numbers read back to the bit. Takes the place of such a file; throws Error{cannot_write} where
/// another one stands, or one that belongs to a result.
void write_local(const Packing&, const LocalPacking&, const std::filesystem::path& file);

}  // namespace bernal
