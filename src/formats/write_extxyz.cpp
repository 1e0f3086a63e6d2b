#include <fmt/format.h>

#include "bernal/version.hpp"
#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// X is the element that is none, to readers that know elements; so types have a column of their own.
void write_extxyz(const Exported& file, StagedFolder& staged) {
  const Bounds<3> box = file.box();
  const Vector<3> size = box.size();
  const bool typed = file.type_count > 1;
  TextFile out(staged.add(file.output.file.string()));
  out.add(file.size(), "\nLattice=\"", size[0], " 0 0 0 ", size[1], " 0 0 0 ", size[2], "\" Origin=\"",
          row_of(box.lower), "\" pbc=\"", file.periods_as("T", "F"),
          "\" Properties=id:I:1:species:S:1:pos:R:3:radius:R:1", typed ? ":class:I:1" : "",
          " unit=", name_of(file.unit()), " packing_fraction=", file.packing.packing_fraction(),
          " generator=\"bernal ", version(), "\"\n");
  for (std::size_t i = 0; i < file.size(); ++i) {
    out.add(i + 1, " X ", file.coordinate(0, i), ' ', file.coordinate(1, i), ' ', file.coordinate(2, i), ' ',
            file.spheres.r[i]);
    if (typed) out.add(' ', file.types[i]);
    out.add('\n');
  }
  out.close();
}

}  // namespace

const Format& extxyz_format() {
  static const Format format{
      .table = {.keys = output_entry("extxyz", "extended XYZ, for OVITO and ASE", {"unit", "types"}),
                .file = "extxyz.xyz",
                .least_dimension = 2},
      .write = write_extxyz};
  return format;
}

}  // namespace bernal
