#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// Throws Error{cannot_write} where a file of a scene's result would take the place of one that stands there
/// and is none of the `earlier` result's, see `files_of_earlier_result`: in the folder, and in those below of
/// what lies inside the spheres. A scene there that bernal would write again to the byte may be replaced.
void require_free_places(const std::filesystem::path& folder, const Scene&,
                         const std::vector<std::string>& earlier);

/// What the result of a scene may be: those of every result, and those of its outputs.
std::vector<std::string> names_of_result_of(const Scene&);

/// "template-007", of so many.
std::string folder_of_template(std::size_t number, std::size_t of);

}  // namespace bernal
