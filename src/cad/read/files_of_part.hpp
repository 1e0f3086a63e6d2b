#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// "a%20b.bin" as "a b.bin".
std::string percent_decoded(std::string_view text);

/// The files of a part: the given one, then for glTF the buffers that it names, in its order, as written or
/// percent-encoded; for STEP the STEP files beside it that it names, and so on recursively.
std::vector<std::filesystem::path> files_of_part(const std::filesystem::path& file);

/// The digest of these files concatenated: what `cat part.gltf part.bin | sha256sum` prints.
std::string sha256_of_part(const std::filesystem::path& file);

}  // namespace bernal
