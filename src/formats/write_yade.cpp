#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

void write_yade(const Exported& file, StagedFolder& staged) {
  TextFile out(staged.add(file.output.file.string()));
  out.add("#format x_y_z_r\n# ", file.title(), "; lengths in ", name_of(file.unit()), "\n");
  out.add("# from yade import ymport; O.bodies.append(ymport.textExt(\"", file.name(), "\"))\n");
  if (const auto* box = std::get_if<Box>(&file.domain); box && !box->has_walls())
    out.add("# O.periodic = True; O.cell.setBox(", box->size[0], ", ", box->size[1], ", ", box->size[2],
            ")\n");
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(file.coordinate(0, i), '\t', file.coordinate(1, i), '\t', file.coordinate(2, i), '\t',
            file.spheres.r[i], '\n');
  out.close();
}

}  // namespace

const Format& yade_format() {
  static const Format format{.table = {.keys = output_entry("yade", "YADE, for ymport.textExt", {"unit"}),
                                       .file = "yade.txt",
                                       .unit = Unit::m},
                             .write = write_yade};
  return format;
}

}  // namespace bernal
