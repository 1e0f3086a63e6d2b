#pragma once
#include <filesystem>

#include "bernal/run/packing.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal {

/// The file that is meant by a name, or by a link to it, whether it stands or not. Throws Error{cannot_write}
/// where that is a folder, a device or a pipe, or no name of a file.
std::filesystem::path file_meant_by(const std::filesystem::path& named);

/// Throws Error{cannot_write} where one of the files of an output in the folder would take the place of what
/// the packing is read or made from, of a file of any result, or, being one that goes with the file that was
/// named, of what bernal did not write. Precondition: the output is complete.
void require_free_places(const Packing&, const Output&, const std::filesystem::path& folder);

}  // namespace bernal
