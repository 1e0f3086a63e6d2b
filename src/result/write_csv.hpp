#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bernal/scene/packing.hpp"

#include "files/output_file.hpp"

namespace bernal {

/// "x,y,z,r" in three dimensions, "x0,x1,…,r" in others.
std::string csv_header(int dimension);
std::vector<std::string> csv_columns(int dimension);

/// What follows the header where a scene tells spheres apart, and in every line the class and its material.
inline constexpr std::string_view csv_class_columns = ",class,material";

/// `# unit: mm`, the header, then one sphere a line. Every number is the shortest decimal that
/// reads back as the same double, so what is certified after reading is what was packed. Cost: about 0.3 µs a
/// sphere on one core; blocks of lines are made in parallel. Memory: some megabytes.
void write_csv(OutputFile& file, const Packing& packing);

}  // namespace bernal
