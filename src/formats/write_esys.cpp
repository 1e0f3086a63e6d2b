#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// A reader of geometries takes no comments: the unit stands nowhere in the file.
void write_esys(const Exported& file, StagedFolder& staged) {
  const Bounds<3> box = file.box();
  TextFile out(staged.add(file.output.file.string()));
  out.add("LSMGeometry 1.2\nBoundingBox ", row_of(box.lower), ' ', row_of(box.upper), "\nPeriodicBoundaries ",
          file.periods_as("1", "0"), "\nDimension ", file.dimension(), "D\nBeginParticles\nSimple\n",
          file.size(), '\n');
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(file.coordinate(0, i), ' ', file.coordinate(1, i), ' ', file.coordinate(2, i), ' ',
            file.spheres.r[i], ' ', i, ' ', file.types[i], '\n');
  out.add("EndParticles\nBeginConnect\n0\nEndConnect\n");
  out.close();
}

}  // namespace

const Format& esys_format() {
  static const Format format{
      .table = {.keys = output_entry("esys", "ESyS-Particle geometry, LSMGeometry 1.2, for readGeometry",
                                     {"unit", "types"}),
                .file = "esys.geo",
                .least_dimension = 2},
      .write = write_esys};
  return format;
}

}  // namespace bernal
