#include "bernal/formats/import.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/domain/domain.hpp"
#include "files/csv_lines.hpp"
#include "files/file_kind.hpp"
#include "formats/import_domain.hpp"
#include "result/result_folder.hpp"

namespace bernal {
namespace {

[[noreturn]] void refuse_option(const std::string& why) { throw Error(ErrorCode::bad_argument, why); }

[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorCode::bad_packing, why, {file.string()});
}

bool is_link(const std::filesystem::path& file) {
  std::error_code unknown;
  return std::filesystem::is_symlink(std::filesystem::symlink_status(file, unknown));
}

void require_file(const std::filesystem::path& file) {
  switch (kind_of_file(file)) {
    case FileKind::regular:
      return;
    case FileKind::missing:
      return refuse_file(file, is_link(file)
                                   ? "is a link that leads nowhere; give the file that it should lead to"
                                   : "there is no such file");
    case FileKind::folder:
      return refuse_file(file, "is a folder; give a file, such as the spheres.csv in it");
    case FileKind::other:
      return refuse_file(file, "is a pipe or a device; save what comes out of it to a file first");
  }
}

void check_options(const ImportOptions& options) {
  if (options.diameter && options.radius)
    refuse_option("‹diameter› and ‹radius› say the same; give one of them");
  for (const auto& [name, length] : {std::pair{"diameter", options.diameter}, {"radius", options.radius}})
    if (length && !is_size(*length))
      refuse_option(fmt::format("‹{}›: {}", name, size_error(*length, name[0] == 'd')));
  for (const double edge : options.box)
    if (!is_size(edge)) refuse_option(fmt::format("‹box›: {} is no length of an edge", edge));
  for (const double along : options.shift)
    if (!(std::abs(along) <= farthest_place)) refuse_option(fmt::format("‹shift›: {} is no length", along));
  if (options.dimension && *options.dimension != 2 && *options.dimension != 3)
    refuse_option("‹dimension› is 2 or 3");
}

/// Converts to two dimensions, if the file or the options say so.
void flatten(FileContents& contents, const Reading& reading) {
  const bool wanted = reading.options.dimension ? *reading.options.dimension == 2 : contents.is_flat;
  std::vector<std::vector<double>>& x = contents.spheres.x;
  if (const auto& asked = reading.options.dimension;
      asked && x.size() != 3 && x.size() != static_cast<std::size_t>(*asked))
    refuse_file(reading.file,
                fmt::format("has {} coordinates of each sphere, and ‹dimension› says {}; leave it out, or "
                            "name the other columns",
                            x.size(), *asked));
  if (!wanted || x.size() != 3) return;
  const auto other = std::ranges::find_if(x[2], [&](double z) { return z != x[2].front(); });
  if (other != x[2].end())
    refuse_file(reading.file,
                fmt::format("discs have one z, but these have {} and {}{}", x[2].front(), *other,
                            reading.options.dimension ? "; leave ‹dimension› out" : ""));
  x.pop_back();
}

void take_sizes(FileContents& contents, const Reading& reading) {
  const ImportOptions& options = reading.options;
  const bool given = options.diameter || options.radius;
  if (!contents.spheres.r.empty()) {
    if (given) refuse_option("the file has sizes of its own; leave ‹diameter› and ‹radius› out");
    return;
  }
  if (!given)
    refuse_file(
        reading.file,
        "does not say how large its spheres are; give ‹diameter› or ‹radius›, or where it has columns "
        "name that of the size by ‹columns›");
  contents.spheres.r.assign(contents.size(), options.radius ? *options.radius : 0.5 * *options.diameter);
}

void move_by(Spheres<dynamic>& spheres, const std::vector<double>& shift) {
  if (shift.empty()) return;
  if (shift.size() != spheres.x.size())
    refuse_option(fmt::format("‹shift› needs a length for each of {} dimensions, not {}", spheres.x.size(),
                              shift.size()));
  for (std::size_t k = 0; k < shift.size(); ++k)
    for (double& x : spheres.x[k]) x += shift[k];
}

/// Returns the number of centres outside.
std::size_t wrapped_into(const Domain& domain, Spheres<dynamic>& spheres) {
  if (!is_periodic(domain)) return 0;
  const Spheres<dynamic> before = spheres;
  wrap(spheres, domain);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    bool same = true;
    for (std::size_t k = 0; k < spheres.x.size(); ++k) same = same && spheres.x[k][i] == before.x[k][i];
    moved += !same;
  }
  return moved;
}

/// Catches errors in unit or size, which would make the certificate extremely slow.
void require_sensible(const Packing& packing, const std::filesystem::path& file) {
  const double phi = packing.packing_fraction();
  if (!(phi <= most_filled))
    refuse_file(file,
                fmt::format("its spheres have {:.3g} times the volume of the {} they are to lie in; check "
                            "‹unit›, ‹box›, and whether its sizes are diameters or radii",
                            phi, name_of(packing.domain)));
}

void require_elsewhere(const std::filesystem::path& file, const std::filesystem::path& folder) {
  if (is_in_place_of_result(file, folder))
    throw Error(ErrorCode::cannot_write,
                "is the file being imported, and the result would take its place; give another ‹folder›",
                {file.string()});
}

std::string range_of_sizes(const std::vector<double>& radii) {
  const auto [least, most] = std::ranges::minmax(radii);
  return least == most ? fmt::format("diameter {:.6g}", 2 * least)
                       : fmt::format("diameters {:.6g} to {:.6g}", 2 * least, 2 * most);
}

/// The packing of what was read; `from` and `format` say where.
ImportedPacking taken_over(FileContents contents, const Reading& reading, const std::string& from,
                           std::string_view format) {
  const ImportOptions& options = reading.options;
  flatten(contents, reading);
  take_sizes(contents, reading);
  const Unit unit = unit_of_import(contents, reading);
  move_by(contents.spheres, options.shift);
  ImportDomain place = domain_of_import(contents, unit, reading);
  move_by(contents.spheres, place.shift);

  ImportedPacking made;
  Packing& packing = made.packing;
  const std::size_t moved = wrapped_into(place.domain, contents.spheres);
  packing.spheres = std::move(contents.spheres);
  packing.domain = std::move(place.domain);
  packing.volume = volume_of(packing.domain);
  packing.scene = std::move(place.scene);
  if (!contents.layers.empty() && packing.scene.dimension() == 3)
    packing.scene.layers = std::move(contents.layers);
  packing.program = this_program();
  packing.expected_packing_fraction = std::numeric_limits<double>::quiet_NaN();  // unknown
  packing.outcome = Outcome::imported;
  packing.reason = fmt::format(
      "{} read from {}, {}",
      packing.spheres.size() == 1 ? "1 sphere" : grouped(packing.spheres.size()) + " spheres", from, format);
  require_sensible(packing, reading.file);
  if (reading.monitor.stop()) throw Cancelled();
  made.notes.push_back(
      {"format", std::string(format) + (contents.note.empty() ? std::string() : ": " + contents.note)});
  made.notes.push_back(
      {"spheres",
       fmt::format("{}, {} {}, packing fraction {:.4f}{}", grouped(packing.spheres.size()),
                   range_of_sizes(packing.spheres.r), name_of(packing.scene.unit), packing.packing_fraction(),
                   packing.packing_fraction() > 1 ? "; above 1: are the sizes diameters?" : "")});
  std::ranges::move(contents.notes, std::back_inserter(made.notes));
  made.notes.push_back({"domain", place.words});
  if (!place.shift.empty())
    made.notes.push_back({"moved", fmt::format("by {}, so that the corner of the box is at zero",
                                               fmt::format("{:.10g}", fmt::join(place.shift, ", ")))});
  const auto& x = packing.spheres.x;
  if (x.size() == 3 && x[2].size() > 2 &&
      std::ranges::all_of(x[2], [&](double z) { return z == x[2].front(); }))
    made.notes.push_back({"plane", "all centres have one z; ‹dimension=2› takes them for discs"});
  if (moved > 0)
    made.notes.push_back({"wrapped", fmt::format("{} of {} centres, which lay outside the box",
                                                 grouped(moved), grouped(packing.spheres.size()))});
  return made;
}

/// Throws unless these are lengths, as many for each axis as there are sizes.
void check_spheres(const Spheres<dynamic>& spheres) {
  for (const std::vector<double>& x : spheres.x) {
    if (x.size() != spheres.r.size())
      refuse_option(fmt::format("there are {} coordinates and {} radii", x.size(), spheres.r.size()));
    const auto none = std::ranges::find_if_not(x, [](double at) { return std::abs(at) <= farthest_place; });
    if (none != x.end())
      refuse_option(fmt::format("sphere {}: {} is not finite or is beyond {}", none - x.begin(), *none,
                                farthest_place));
  }
  const auto none = std::ranges::find_if_not(spheres.r, is_size);
  if (none != spheres.r.end())
    refuse_option(fmt::format("sphere {}: {}", none - spheres.r.begin(), size_error(*none, false)));
}

}  // namespace

ImportedPacking import_packing(const std::filesystem::path& file, const ImportOptions& options,
                               const Monitor& monitor) {
  check_options(options);
  require_file(file);
  const Reading reading{file, options, monitor};
  const Format& format = format_of(file, options);
  FileContents contents = format.read(reading);
  if (monitor.stop()) throw Cancelled();
  if (contents.size() == 0) refuse_file(file, "there are no spheres in it");
  return taken_over(std::move(contents), reading, plain_text(file.filename().string()), format.name);
}

ImportedPacking import_spheres(Spheres<dynamic> spheres, const ImportOptions& options,
                               const Monitor& monitor) {
  check_options(options);
  check_spheres(spheres);
  if (spheres.size() == 0) refuse_option("there are no spheres");
  const std::filesystem::path no_file;
  return taken_over({.spheres = std::move(spheres)}, {no_file, options, monitor}, "memory", "arrays");
}

void check_importable(const std::filesystem::path& file, const std::filesystem::path& folder) {
  require_file(file);
  require_elsewhere(file, folder);
  Scene scene;
  scene.start.file = file;
  check_writable(folder, scene);
}

WrittenPacking write_imported(Packing packing, const std::filesystem::path& file,
                              const std::filesystem::path& folder, WriteOptions options) {
  options.all_or_nothing = true;
  if (!file.empty()) {
    require_elsewhere(file, folder);
    packing.scene.start.file = file;
  }
  check_writable(folder, packing.scene, options);
  packing.scene.start.file = folder / spheres_file_of(packing, options);
  try {
    return write_packing(packing, folder, options);
  } catch (const Error& error) {  // measuring fails if nearly all spheres overlap
    if (error.code() != ErrorCode::bad_argument) throw;
    refuse_file(file, fmt::format("{}; check its sizes and their unit", error.what()));
  }
}

}  // namespace bernal
