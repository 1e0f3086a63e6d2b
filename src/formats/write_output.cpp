#include "io/write_output.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/formats/export.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"
#include "formats/format.hpp"
#include "formats/targets.hpp"

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

/// Of pairs, whatever the walls.
double largest_overlap(const Spheres<dynamic>& spheres, const Domain& domain, const Monitor& monitor) {
  const Certificate certificate = certify(spheres, without_walls(domain), {.monitor = monitor});
  if (certificate.cancelled) throw Cancelled();
  return certificate.max_overlap;
}

/// Of a packing that nobody certified, or whose scene allows it; else nothing.
std::string words_on_overlap(const Packing& packing, double overlap) {
  if (!(overlap > 0)) return {};
  return fmt::format("the packing itself overlaps: largest {:.2g} of the sum of two radii, {}", overlap,
                     overlap <= packing.scene.overlap
                         ? fmt::format("of which its scene allows {:.2g}", packing.scene.overlap)
                         : "and bernal verify says where");
}

std::string words_on_overlap(const Packing& packing, const Monitor& monitor) {
  return words_on_overlap(packing, largest_overlap(packing.spheres, packing.domain, monitor));
}

/// What solids and surfaces cannot be right with. Walls matter where they are made too.
void take_faults(Exported& file, const Format& format, const Monitor& monitor) {
  const Packing& packing = file.packing;
  const bool with_walls = format.table.sizes == "solids" || format.table.sizes == "triangles";
  const Certificate certificate = certify(
      packing.spheres, with_walls ? packing.domain : without_walls(packing.domain), {.monitor = monitor});
  if (certificate.cancelled) throw Cancelled();
  file.overlap = certificate.max_overlap;
  if (!with_walls) return;
  file.protruding = certificate.protruding_spheres;
  file.protrusion = -certificate.min_wall_gap;
}

std::string words_on_faults(const Exported& file) {
  std::string words;
  if (const std::string itself = words_on_overlap(file.packing, file.overlap); !itself.empty())
    words += "; " + itself;
  if (file.protruding > 0)
    words += fmt::format(
        "; {} through the walls or {} outside, by up to {:.2g} of the radius: bernal verify says where",
        file.protruding == 1 ? "1 sphere goes" : grouped(file.protruding) + " spheres go",
        file.protruding == 1 ? "lies" : "lie", file.protrusion);
  return words;
}

/// Whether its numbers are others than those of the packing.
bool is_rounded(const Exported& file, const Format& format) {
  return format.precision == Precision::as_float || file.unit() != file.packing.scene.unit || file.wrapped;
}

/// Of touching spheres, the most that rounding makes: each coordinate is rounded up to three times, when it
/// is converted, moved to the middle and put into the period, by half an epsilon of the farthest c there is,
/// and so is the period: the distance of two loses up to 4 sqrt(3) epsilon c, of which the radii are at least
/// 2 r.
double most_by_rounding(const Packing& packing, const Format& format) {
  const double epsilon = format.precision == Precision::as_float ? std::numeric_limits<float>::epsilon()
                                                                 : std::numeric_limits<double>::epsilon();
  if (packing.spheres.empty()) return 0;
  const Bounds<dynamic> bounds = bounds_of<dynamic>(packing.domain);
  const double farthest = std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff()),
               smallest = *std::ranges::min_element(packing.spheres.r);
  return epsilon * (4 * farthest / smallest + 1);
}

/// What rounding did, in words; what the packing overlaps itself is not put down to it.
std::string words_on_rounding(const Exported& file, const Format& format, const Monitor& monitor) {
  if (!is_rounded(file, format)) {
    const std::string itself = words_on_overlap(file.packing, monitor);
    const std::string kept = file.contacts.changed == 0
                                 ? "the numbers of spheres.csv, not rounded"
                                 : "centres are the numbers of spheres.csv, not rounded";
    return kept + (itself.empty() ? "" : "; " + itself);
  }
  const std::string to =
      format.precision == Precision::as_float ? "single precision" : fmt::format("{}", name_of(file.unit()));
  const double overlap = largest_overlap(file.spheres, file.domain, monitor);
  if (!(overlap > 0)) return fmt::format("no overlap after rounding to {}", to);
  if (overlap > most_by_rounding(file.packing, format))
    if (const std::string itself = words_on_overlap(file.packing, monitor); !itself.empty()) return itself;
  std::string remedy;
  if (format.precision == Precision::as_float)
    remedy = "; extxyz and npy round nothing";
  else if (format.table.keys.find("unit"))
    remedy = fmt::format("; the unit {} rounds nothing", name_of(file.packing.scene.unit));
  return fmt::format("largest overlap after rounding to {}: {:.2g} of the sum of two radii{}", to, overlap,
                     remedy);
}

std::string spheres_in(const Exported& file) {
  return fmt::format("{} {}, lengths in {}", grouped(file.size()), file.size() == 1 ? "sphere" : "spheres",
                     name_of(file.unit()));
}

/// `told` by whoever wrote the file; or empty.
std::string note_of(const Exported& file, const Format& format, const std::string& told,
                    const Monitor& monitor) {
  const std::string remark = format.remark ? format.remark(file) : "";
  const std::string contacts =
      file.contacts.treatment == ContactTreatment::none ? "" : "; " + words_on(file.contacts);
  if (format.note || !told.empty())
    return fmt::format("{}, {}{}{}{}", spheres_in(file), format.note ? format.note(file) : told, contacts,
                       words_on_faults(file), remark);
  const OutputTable& table = format.table;
  std::string note =
      fmt::format("{}, {}", spheres_in(file), table.sizes == "diameter" ? "diameters" : "radii");
  if (table.keys.find("density")) note += fmt::format(", density {} kg/m3", file.output.density);
  if (table.keys.find("types"))
    note += fmt::format(", {} {}", file.type_count, file.type_count == 1 ? "type" : "types");
  return note + contacts + "; " + words_on_rounding(file, format, monitor) + remark;
}

}  // namespace

std::string write_output(const Packing& packing, const Output& output, StagedFolder& staged,
                         const Monitor& monitor) {
  const Interruptible interruptible(monitor);
  const Format& format = format_of(output);
  Exported file = exported(packing, output, monitor);
  if (format.note || format.write_and_tell) take_faults(file, format, monitor);
  std::string told;
  if (format.write_and_tell)
    told = format.write_and_tell(file, staged);
  else
    format.write(file, staged);
  return note_of(file, format, told, monitor);
}

WrittenExport write_export(const Packing& packing, const Output& asked, const fs::path& file,
                           const Monitor& monitor) {
  if (table_of(asked).is_folder && stands(file))
    throw Error(ErrorCode::cannot_write, "stands there already; give another name with -o, or move it away",
                {file.string()});
  const fs::path meant = file_meant_by(file);
  Output output = asked;
  output.file = meant.filename();
  complete_output(output, packing.scene);
  const fs::path folder = meant.parent_path().empty() ? "." : meant.parent_path();
  require_free_places(packing, output, folder);
  StagedFolder staged(folder);
  const std::string note = write_output(packing, output, staged, monitor);
  WrittenExport written{staged.publish(), note};
  for (fs::path& path : written.files) path = path.lexically_normal();
  return written;
}

}  // namespace bernal
