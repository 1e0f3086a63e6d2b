#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"
#include "files/staged_folder.hpp"
#include "report/nest_json.hpp"

namespace bernal {

/// The file that says which packings lie inside the spheres of a result.
inline constexpr const char* nest_file = "nest.json";

/// Beside the packings inside the spheres of a class: which of them each sphere holds, and how it is turned.
inline constexpr const char* table_of_rotations = "rotations.csv";

/// Where what lies inside the spheres of a packing stands in the folder of its result.
std::vector<InsideFiles> files_of_insides(const Packing&);

/// nest.json and the tables: which packing each sphere holds, and how it is turned. They are read back.
/// Throws Error{cannot_write} where that gives anything else.
void write_nest(const Packing&, StagedFolder&);

/// Fills in `Packing::inside` from the folder of its result. Throws Error{bad_packing} for files that are not
/// there or do not go together.
void read_nest(Packing&, const std::filesystem::path& folder);

}  // namespace bernal
