#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// "a%20b.bin" as "a b.bin".
std::string percent_decoded(std::string_view text);

/// The files that hold a part: the one given, then the buffers beside it that a glTF names, in its order, as
/// they are written or percent-encoded, or the STEP files beside it that a STEP file names, and these again.
std::vector<std::filesystem::path> files_of_part(const std::filesystem::path& file);

/// Of the bytes of these one after another: what `cat part.gltf part.bin | sha256sum` prints.
std::string sha256_of_part(const std::filesystem::path& file);

}  // namespace bernal
