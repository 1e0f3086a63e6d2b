#pragma once
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "io/output_file.hpp"

namespace bernal {

/// `# unit: mm`, the header `x,y,z,r`, then one sphere a line. Every number is the shortest decimal that
/// reads back as the same double, so what is certified after reading is what was packed. Cost: about 0.3 µs a
/// sphere.
void write_csv(OutputFile& file, const Spheres<3>& spheres, std::string_view unit);

}  // namespace bernal
