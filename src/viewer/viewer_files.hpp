#pragma once
#include <string_view>

namespace bernal {

/// The files of src/viewer/page, as the build found them; see cmake/embed_viewer.cmake.
extern const std::string_view viewer_style, viewer_script;

}  // namespace bernal
