#pragma once
#include <string_view>

#include "viewer/html.hpp"

namespace bernal {

/// What a page needs to forbid itself everything outside of it, in its head.
inline constexpr std::string_view offline_policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
    "script-src 'unsafe-inline'; img-src data: blob:\">\n";

/// The element that the view appears in, where the browser has WebGL 2; else nothing is seen of it.
void write_view_frame(Page&);

/// The spheres and the program that shows them, at the end of the page; `data` as `view_data` makes it.
void write_view_program(Page&, std::string_view data);

}  // namespace bernal
