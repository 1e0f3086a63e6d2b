#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

void write_pfc(const Exported& file, StagedFolder& staged) {
  const int dimension = file.dimension();
  const Bounds<3> box = file.box();
  const auto periodic = file.periods();
  TextFile out(staged.add(file.output.file.string()));
  out.add("; ", file.title(), "; lengths in ", name_of(file.unit()), "\n; PFC", dimension,
          "D 6 or later: model new, then program call '", file.name(), "'\n");
  out.add("model domain extent");
  for (int k = 0; k < dimension; ++k) out.add(' ', box.lower[k], ' ', box.upper[k]);
  out.add(" condition");
  for (int k = 0; k < dimension; ++k) out.add(periodic[static_cast<std::size_t>(k)] ? " periodic" : " stop");
  out.add('\n');
  for (std::size_t i = 0; i < file.size(); ++i) {
    out.add("ball create id ", i + 1, " radius ", file.spheres.r[i], " position");
    for (int k = 0; k < dimension; ++k) out.add(' ', file.coordinate(k, i));
    if (file.type_count > 1) out.add(" group 'type_", file.types[i], "'");
    out.add('\n');
  }
  out.add("ball attribute density ", file.output.density, '\n');
  out.close();
}

}  // namespace

const Format& pfc_format() {
  static const Format format{
      .table = {.keys = output_entry("pfc", "Itasca PFC 6 or later, commands for program call",
                                     {"density", "types"}),
                .file = "pfc.dat",
                .least_dimension = 2,
                .unit = Unit::m},
      .write = write_pfc};
  return format;
}

}  // namespace bernal
