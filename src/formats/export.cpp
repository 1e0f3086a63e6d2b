#include "bernal/formats/export.hpp"

#include <algorithm>
#include <limits>
#include <system_error>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"
#include "domain/without_walls.hpp"
#include "files/seal.hpp"
#include "formats/format.hpp"
#include "formats/text_file.hpp"
#include "result/result_folder.hpp"
#include "result/write_output.hpp"
#include "scene/scene_sources.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

[[noreturn]] void refuse_target(const fs::path& file, const std::string& why) {
  throw Error(ErrorCode::cannot_write, why, {file.string()});
}

/// The files that the packing was made from or consists of.
std::vector<fs::path> sources_of(const Packing& packing) {
  const Scene& scene = packing.scene;
  std::vector<fs::path> files = sources_of_scene(scene.file);
  if (!scene.file.empty()) {
    const fs::path folder = scene.file.parent_path();
    for (const std::string_view name : names_of_result) files.push_back(folder / name);
    for (const std::string& source : sources_of_result(folder)) files.push_back(folder / source);
  }
  const auto add_part = [&](const fs::path& part) {
    std::error_code unknown;
    if (!fs::is_regular_file(part, unknown)) return;
    for (const fs::path& file : files_of_part_beside(part)) files.push_back(file);
  };
  for (const MeshFile* mesh : scene.meshes()) {
    add_part(mesh->file);
    for (const fs::path& obstacle : mesh->obstacles) add_part(obstacle);
  }
  if (scene.start.file) files.push_back(*scene.start.file);
  return files;
}

/// The target of a name or link, whether it exists or not. Throws Error{cannot_write} for a folder, a device,
/// a pipe, or an invalid name.
fs::path target_of(const fs::path& named) {
  fs::path file = named;
  std::error_code unknown;
  constexpr int most_links = 40;  // as in the kernel
  for (int k = 0; fs::is_symlink(file, unknown); ++k) {
    if (k == most_links) refuse_target(named, "is a link that leads to itself; give the name of a file");
    const fs::path target = fs::read_symlink(file, unknown);
    file = target.is_absolute() ? target : file.parent_path() / target;
  }
  const fs::path name = file.filename();
  if (name == "." || name == ".." || fs::is_directory(file, unknown))
    refuse_target(named, "is a folder; give the name of a file in it");
  if (stands(file) && !fs::is_regular_file(file, unknown))
    refuse_target(named, "is a device or a pipe, which no file takes the place of; give the name of a file");
  return file;
}

/// Throws Error{cannot_write} if one of the output's files in the folder would replace a source of the
/// packing, a file of any result, or (for files that go with the named one) a file that bernal did not write.
/// Precondition: the output is complete.
void require_free_places(const Packing& packing, const Output& output, const fs::path& folder) {
  std::vector<std::string> names = files_of(output);
  if (const auto beside = format_of(output).beside)
    std::ranges::copy(beside(packing, output), std::back_inserter(names));
  const std::vector<fs::path> sources = sources_of(packing);
  const Manifest of_result = manifest_of(folder);
  std::vector<fs::path> files, of_others;
  for (const std::string& name : names) files.push_back(folder / name);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const fs::path& file = files[k];
    if (!stands(file)) continue;
    std::error_code unknown;
    for (const fs::path& source : sources)
      if (fs::equivalent(file, source, unknown))
        refuse_target(file, "is what the packing is read from, or was made from; give another ‹file›");
    if (of_result.contains(names[k]))
      refuse_target(file, "belongs to the result in that folder; give another ‹file›");
    if (k > 0 && !(fs::is_regular_file(fs::symlink_status(file, unknown)) && is_as_bernal_wrote(file, files)))
      of_others.push_back(file);
  }
  if (of_others.empty()) return;
  // A modified script no longer vouches for the files that go with it.
  std::ranges::stable_partition(of_others, [](const fs::path& file) { return has_seal(file); });
  refuse_target(of_others[0],
                fmt::format("goes with {}, and what stands there bernal did not write, or somebody "
                            "has changed it; give another ‹file›, or move it away",
                            names[0]));
}

/// Over pairs, ignoring walls.
double largest_overlap(const Spheres<dynamic>& spheres, const Domain& domain, const Monitor& monitor) {
  const Certificate certificate = certify(spheres, without_walls(domain), {.monitor = monitor});
  if (certificate.cancelled) throw Cancelled();
  return certificate.max_overlap;
}

/// For an uncertified packing, or one whose scene allows overlap; else empty.
std::string overlap_text(const Packing& packing, double overlap) {
  if (!(overlap > 0)) return {};
  return fmt::format("the packing itself overlaps: largest {:.2g} of the sum of two radii, {}", overlap,
                     overlap <= packing.scene.overlap
                         ? fmt::format("of which its scene allows {:.2g}", packing.scene.overlap)
                         : "and bernal verify says where");
}

/// Records faults that solids and surfaces cannot represent. Walls count only for formats that include them.
void find_faults(Exported& file, const Format& format, const Monitor& monitor) {
  const Packing& packing = file.packing;
  const bool with_walls = format.sizes == "solids" || format.sizes == "triangles";
  const Certificate certificate =
      certify(packing.spheres, with_walls ? packing.domain : Domain(without_walls(packing.domain)),
              {.monitor = monitor});
  if (certificate.cancelled) throw Cancelled();
  file.overlap = certificate.max_overlap;
  if (!with_walls) return;
  file.protruding = certificate.protruding_spheres;
  file.protrusion = -certificate.min_wall_gap;
}

std::string faults_text(const Exported& file) {
  std::string words;
  if (const std::string itself = overlap_text(file.packing, file.overlap); !itself.empty())
    words += "; " + itself;
  if (file.protruding > 0)
    words += fmt::format(
        "; {} through the walls or {} outside, by up to {:.2g} of the radius: bernal verify says where",
        file.protruding == 1 ? "1 sphere goes" : grouped(file.protruding) + " spheres go",
        file.protruding == 1 ? "lies" : "lie", file.protrusion);
  return words;
}

/// Whether its numbers differ from those of the packing.
bool is_rounded(const Exported& file, const Format& format) {
  return format.precision == Precision::as_float || file.unit() != file.packing.scene.unit || file.wrapped;
}

/// The largest overlap that rounding can cause between touching spheres: each coordinate is rounded up to
/// three times (conversion, shift to the middle, wrapping), by half an epsilon of the largest coordinate c,
/// and so is the period; so the distance of two spheres loses up to 4 sqrt(3) epsilon c, relative to radii of
/// at least 2 r together.
double most_by_rounding(const Packing& packing, const Format& format) {
  const double epsilon = format.precision == Precision::as_float ? std::numeric_limits<float>::epsilon()
                                                                 : std::numeric_limits<double>::epsilon();
  if (packing.spheres.empty()) return 0;
  const Bounds<dynamic> bounds = bounds_of<dynamic>(packing.domain);
  const double farthest = std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff()),
               smallest = *std::ranges::min_element(packing.spheres.r);
  return epsilon * (4 * farthest / smallest + 1);
}

/// The effect of rounding, in words; overlaps of the packing itself are not attributed to it.
std::string rounding_text(const Exported& file, const Format& format, const Monitor& monitor) {
  if (!is_rounded(file, format)) {
    const std::string itself =
        overlap_text(file.packing, largest_overlap(file.packing.spheres, file.packing.domain, monitor));
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
    if (const std::string itself =
            overlap_text(file.packing, largest_overlap(file.packing.spheres, file.packing.domain, monitor));
        !itself.empty())
      return itself;
  std::string remedy;
  if (format.precision == Precision::as_float)
    remedy = "; extxyz and npy round nothing";
  else if (table_of(file.output).keys.find("unit"))
    remedy = fmt::format("; the unit {} rounds nothing", name_of(file.packing.scene.unit));
  return fmt::format("largest overlap after rounding to {}: {:.2g} of the sum of two radii{}", to, overlap,
                     remedy);
}

std::string spheres_in(const Exported& file) {
  return fmt::format("{} {}, lengths in {}", grouped(file.size()), file.size() == 1 ? "sphere" : "spheres",
                     name_of(file.unit()));
}

/// What the scene says of its spheres and the file does not, as it holds whole spheres of the outermost
/// level.
std::string left_out_text(const Exported& file, const Format& format) {
  if (format.holds_levels && format.holds_levels(file.output)) return {};
  const auto& keys = table_of(file.output).keys;
  const bool knows_layers = keys.find("layers") || keys.find("layer") || keys.find("values");
  const bool has_insides = !file.packing.inside.empty();
  const bool drops_layers = !knows_layers && has_layers(file.packing.scene);
  std::string what = drops_layers ? "the layers of spheres are" : "what lies inside of them is";
  if (drops_layers && has_insides) what = "the layers of spheres and what lies inside of them are";
  if (!has_insides && !drops_layers) return {};
  return fmt::format("; {} left out: openmc, as .xml or a folder, serpent and scone hold all levels", what);
}

/// `written` is the writer's own description, or empty.
std::string note_of(const Exported& file, const Format& format, const std::string& written,
                    const Monitor& monitor) {
  const std::string remark = (format.remark ? format.remark(file) : "") + left_out_text(file, format);
  const std::string contacts =
      file.contacts.treatment == ContactTreatment::none ? "" : "; " + contact_text(file.contacts);
  if (format.note || !written.empty())
    return fmt::format("{}, {}{}{}{}", spheres_in(file), format.note ? format.note(file) : written, contacts,
                       faults_text(file), remark);
  const OutputTable& table = table_of(file.output);
  std::string note =
      fmt::format("{}, {}", spheres_in(file), table.sizes == "diameter" ? "diameters" : "radii");
  if (table.keys.find("material_density"))
    note += fmt::format(", density {} kg/m3", file.densities_in_words());
  if (table.keys.find("types"))
    note += fmt::format(", {} {}", file.type_count, file.type_count == 1 ? "type" : "types");
  return note + contacts + "; " + rounding_text(file, format, monitor) + remark;
}

}  // namespace

std::string write_output(const Packing& packing, const Output& output, StagedFolder& staged,
                         const Monitor& monitor) {
  const Interruptible interruptible(monitor);
  const Format& format = format_of(output);
  Exported file = exported(packing, output, monitor);
  if (format.note || format.write_with_note) find_faults(file, format, monitor);
  std::string written;
  if (format.write_text) {
    TextFile out(staged.add(file.output.file.string()));
    format.write_text(file, out);
    out.close();
  } else if (format.write_with_note) {
    written = format.write_with_note(file, staged);
  } else {
    format.write(file, staged);
  }
  return note_of(file, format, written, monitor);
}

WrittenExport write_export(const Packing& packing, const Output& asked, const fs::path& file,
                           const Monitor& monitor) {
  if (is_folder(table_of(asked), file) && stands(file))
    throw Error(ErrorCode::cannot_write, "stands there already; give another ‹file›, or move it away",
                {file.string()});
  const fs::path meant = target_of(file);
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
