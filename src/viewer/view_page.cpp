#include "bernal/viewer/view_page.hpp"

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "viewer/html.hpp"
#include "viewer/viewer_data.hpp"
#include "viewer/viewer_files.hpp"
#include "viewer/viewer_parts.hpp"

namespace bernal {

void write_view_frame(Page& page) {
  page.raw(
      "<section class=\"bernal-view\" aria-label=\"Interactive view\" hidden></section>\n"
      "<script>if (window.WebGL2RenderingContext) "  // immediately, so that nothing moves later
      "document.currentScript.previousElementSibling.hidden = false;</script>\n");
}

void write_view_program(Page& page, std::string_view data) {
  page.raw("<script type=\"application/json\" class=\"bernal-data\">");
  page.raw(data);
  page.raw("</script>\n<script>\n");
  page.raw(viewer_script);
  page.raw("</script>\n");
}

std::string view_page(const Packing& packing, const Measurements* measured, const ViewOptions& options) {
  using Theme = ViewOptions::Theme;
  if (!has_view(packing.spheres.dimension()))
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("there is no view of {} dimensions, only of two and three; measure has numbers of "
                    "every dimension",
                    packing.spheres.dimension()));
  Page page;
  page.add(
      "<!doctype html>\n<html lang=\"en\" class=\"bernal-page{}\"><head><meta charset=\"utf-8\">\n{}"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>{} {} in a {}</title>\n<style>",
      options.theme == Theme::light  ? " bernal-light"
      : options.theme == Theme::dark ? " bernal-dark"
                                     : "",
      offline_policy, grouped(packing.spheres.size()),
      in_dimension(packing.spheres.dimension(), packing.spheres.size() == 1 ? "sphere" : "spheres"),
      name_of(packing.domain));
  page.raw(viewer_style);
  page.raw("</style></head>\n<body>\n");
  write_view_frame(page);
  page.raw("<p class=\"bernal-absent\">This view needs WebGL 2 and JavaScript.</p>\n");
  write_view_program(page, view_data(packing, measured, options));
  page.raw("</body></html>\n");
  return std::move(page).finish();
}

}  // namespace bernal
