#pragma once
#include <string_view>

namespace bernal {

/// The files of src/viewer/page, embedded by cmake/embed_viewer.cmake.
extern const std::string_view viewer_style, viewer_script;

}  // namespace bernal
