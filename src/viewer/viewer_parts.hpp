#pragma once
#include <string_view>

#include "viewer/html.hpp"

namespace bernal {

/// Forbids a page all external resources, for its head.
inline constexpr std::string_view offline_policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; img-src data: blob:\">\n";

/// The element of the view, hidden unless the browser has WebGL 2.
void write_view_frame(Page&);

/// The spheres and the program that shows them, at the end of the page; `data` is from `view_data`.
void write_view_program(Page&, std::string_view data);

}  // namespace bernal
