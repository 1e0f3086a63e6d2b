#include "solids/part_in_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "solids/part_maker.hpp"

namespace bernal {

bool is_file_of_part(const std::filesystem::path& file) { return is_mesh_file_name(file); }

ConvexPart part_in_file(const std::filesystem::path& file, Unit unit, double smallest_radius) {
  const ImportedMesh imported = read_mesh({.file = file}, {.unit = unit, .smallest_radius = smallest_radius});
  if (!imported.report.usable())
    refuse_part(fmt::format("is no closed solid: {} has {}", file.string(),
                            fmt::join(imported.report.problems, ", ")));
  return part_bounded_by(imported.mesh);
}

}  // namespace bernal
