#pragma once
#include <filesystem>

#include "bernal/scene/scene.hpp"

namespace bernal {

// What a run leaves that is killed while its files move into their places, see `StagedFolder`. Whoever reads
// a result takes it for what it will be, and moves nothing; whoever writes there completes it first.

/// Where a file of the folder it is in can be read: in its place, or on the way there. Of an earlier result
/// that goes, where it will not be. Waits for a process that is at it.
std::filesystem::path where_it_stands(const std::filesystem::path& file);

/// The file that has the spheres of a result, by the name that it has in its place: the text, unless there is
/// only the array.
std::filesystem::path spheres_file_in(const std::filesystem::path& folder);
/// The same of a folder that is read. Throws Error{bad_packing} where there are both, of which only one is
/// the result.
std::filesystem::path only_spheres_file_in(const std::filesystem::path& folder);

/// The scene of a result, with the CAD files beside it where they stand. Throws as `read_scene`.
Scene scene_in(const std::filesystem::path& folder);

}  // namespace bernal
