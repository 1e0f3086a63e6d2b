#pragma once
#include <filesystem>

#include "bernal/run/packing.hpp"
#include "io/staged_folder.hpp"

namespace bernal {

/// Files that results have, but not all of them: pictures, walls, copies of CAD files.
bool is_of_earlier_result(const std::filesystem::path& file);

/// The scene with the seed that was used, which the caller may have given instead of the scene. `with_mesh`:
/// the CAD files are copied into the folder and named there; throws Error{cannot_write} where one is no
/// longer what was packed into. What stands in the folder anyway stays as it is.
Scene scene_as_run(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                   bool with_mesh);

}  // namespace bernal
