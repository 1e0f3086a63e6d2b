#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"
#include "files/staged_folder.hpp"

namespace bernal {

/// The files of a result by their names; the digests of those that a user may put others into the place of,
/// or change: scene.toml, copies of CAD files, what outputs write. What report.json says of them is what
/// makes a file one of bernal's.
using Manifest = std::map<std::string, std::string>;

/// Of the result that stands in the folder; empty where none does.
Manifest manifest_of(const std::filesystem::path& folder);

/// What the result that stands in the folder was made from, as far as its scene does not name it: paths
/// relative to the folder.
std::vector<std::string> sources_of_result(const std::filesystem::path& folder);

/// A CAD file and those that it names, see `files_of_part`.
std::vector<std::filesystem::path> files_of_part_beside(const std::filesystem::path& part);

/// Those of an earlier result that nobody has written into since.
std::vector<std::string> files_of_earlier_result(const std::filesystem::path& folder);

/// Whether a file, or what it leads to by a link, stands where a result in the folder writes one.
bool is_in_place_of_result(const std::filesystem::path& file, const std::filesystem::path& folder);

/// The scene with the seed that was used, which the caller may have given instead of the scene. `with_mesh`:
/// the files that it names are copied into the folder and named there; throws Error{cannot_write} where one
/// is no longer what was packed into. What stands in the folder anyway stays as it is. Adds to the manifest
/// what is copied, and what an earlier result copied and the scene names.
Scene scene_as_run(const Packing& packing, StagedFolder& staged, const std::filesystem::path& folder,
                   bool with_mesh, Manifest& manifest);

}  // namespace bernal
