#include "io/write_output.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/export/export.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"
#include "export/format.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

/// The domain with its walls moved out of reach, so that a certificate is one of pairs.
Domain without_walls(const Domain& domain) {
  const Bounds<dynamic> bounds = bounds_of<dynamic>(domain);
  Box box{bounds.lower, bounds.size(), std::vector<bool>(static_cast<std::size_t>(dimension_of(domain)))};
  const auto* given = std::get_if<Box>(&domain);
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  for (int k = 0; k < box.dimension(); ++k) {
    const bool repeats =
        given ? given->repeats(k) : cylinder && cylinder->periodic && cylinder->coordinate_axis() == k;
    box.periodic[static_cast<std::size_t>(k)] = repeats;
    if (repeats) continue;
    box.corner[k] -= box.size[k];
    box.size[k] *= 3;
  }
  return box;
}

/// What rounding did, in words.
std::string words_on_rounding(const Exported& file, const Format& format, const Monitor& monitor) {
  const Unit scene = file.packing.scene.unit;
  if (format.precision == Precision::as_double && file.unit() == scene)
    return "the numbers of spheres.csv, not rounded";
  const std::string to =
      format.precision == Precision::as_float ? "single precision" : fmt::format("{}", name_of(file.unit()));
  const Certificate certificate = certify(file.spheres, without_walls(file.domain), {.monitor = monitor});
  if (certificate.cancelled) throw Cancelled();
  const double overlap = certificate.max_overlap;
  if (!(overlap > 0)) return fmt::format("no overlap after rounding to {}", to);
  std::string remedy;
  if (format.precision == Precision::as_float)
    remedy = "; extxyz and npy round nothing";
  else if (format.table.keys.find("unit"))
    remedy = fmt::format("; the unit {} rounds nothing", name_of(scene));
  return fmt::format("largest overlap after rounding to {}: {:.2g} of the sum of two radii{}", to, overlap,
                     remedy);
}

std::string spheres_in(const Exported& file) {
  return fmt::format("{} {}, lengths in {}", grouped(file.size()), file.size() == 1 ? "sphere" : "spheres",
                     name_of(file.unit()));
}

std::string note_of(const Exported& file, const Format& format, const Monitor& monitor) {
  if (format.note) return fmt::format("{}, {}", spheres_in(file), format.note(file));
  const OutputTable& table = format.table;
  std::string note =
      fmt::format("{}, {}", spheres_in(file), table.sizes == "diameter" ? "diameters" : "radii");
  if (table.keys.find("density")) note += fmt::format(", density {} kg/m3", file.output.density);
  if (table.keys.find("types"))
    note += fmt::format(", {} {}", file.type_count, file.type_count == 1 ? "type" : "types");
  return note + "; " + words_on_rounding(file, format, monitor);
}

/// What the packing was made from, or is.
std::vector<fs::path> inputs_of(const Packing& packing) {
  std::vector<fs::path> files;
  const Scene& scene = packing.scene;
  if (!scene.file.empty())
    for (const std::string_view name : names_of_result) files.push_back(scene.file.parent_path() / name);
  if (const auto* mesh = std::get_if<MeshFile>(&scene.container)) {
    files.push_back(mesh->file);
    files.insert(files.end(), mesh->obstacles.begin(), mesh->obstacles.end());
  }
  if (scene.start.file) files.push_back(*scene.start.file);
  return files;
}

}  // namespace

std::string write_output(const Packing& packing, const Output& output, StagedFolder& staged,
                         const Monitor& monitor) {
  const Interruptible interruptible(monitor);
  const Format& format = format_of(output);
  Exported file = exported(packing, output);
  file.monitor = monitor;
  if (format.write_noted) return fmt::format("{}, {}", spheres_in(file), format.write_noted(file, staged));
  format.write(file, staged);
  return note_of(file, format, monitor);
}

WrittenExport write_export(const Packing& packing, const Output& asked, const fs::path& file,
                           const Monitor& monitor) {
  Output output = asked;
  output.file = file.filename();
  complete_output(output, packing.scene);
  const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
  std::error_code unknown;
  for (const std::string& name : files_of(output))
    for (const fs::path& input : inputs_of(packing))
      if (fs::equivalent(folder / name, input, unknown))
        throw Error(ErrorCode::cannot_write,
                    "is what the packing is read from, or was made from; give another name with -o",
                    {(folder / name).string()});
  StagedFolder staged(folder);
  const std::string note = write_output(packing, output, staged, monitor);
  WrittenExport written{staged.publish(), note};
  for (fs::path& path : written.files) path = path.lexically_normal();
  return written;
}

}  // namespace bernal
