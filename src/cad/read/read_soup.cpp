#include "cad/read/read_soup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/read/files_of_part.hpp"
#include "cad/read/known_formats.hpp"
#include "files/file_kind.hpp"

namespace bernal::cad {

namespace {

/// The triangles of a large polygon overlap each other's boxes, so that the search for crossings is
/// quadratic: 10 s for 20,000 corners, a minute for this many.
constexpr std::size_t most_corners_of_face = 50'000;
/// Products of larger ones overflow, which exact arithmetic does not allow.
constexpr double most_coordinate = 1e50;

}  // namespace

void keep_solids(PolygonSoup& soup, const std::vector<bool>& kept) {
  std::vector<Solid> solids;
  std::vector<std::vector<std::uint32_t>> polygons;
  for (std::size_t i = 0; i < soup.solids.size(); ++i) {
    if (!kept[i]) continue;
    const std::size_t end = i + 1 < soup.solids.size() ? soup.solids[i + 1].first : soup.polygons.size();
    solids.push_back({soup.solids[i].name, polygons.size()});
    for (std::size_t k = soup.solids[i].first; k < end; ++k) polygons.push_back(std::move(soup.polygons[k]));
  }
  soup.solids = std::move(solids);
  soup.polygons = std::move(polygons);
}

namespace {

double largest_coordinate(const PolygonSoup& soup) {
  double largest = 0;
  for (const auto& polygon : soup.polygons)
    for (const std::uint32_t v : polygon) largest = std::max(largest, soup.points[v].cwiseAbs().maxCoeff());
  return largest;
}

/// Texts from the file are printed in terminals and pages.
void make_plain(ReadAttempt& read) {
  constexpr std::size_t most = 200;
  for (Solid& solid : read.soup.solids) solid.name = plain_text(solid.name, most);
  for (auto* length : {&read.facts.unit, &read.facts.written_in})
    if (*length) (*length)->name = plain_text((*length)->name, most);
  for (std::string& note : read.facts.notes) note = plain_text(note, most);
  read.reader = plain_text(read.reader, most);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) {
  throw Error(ErrorCode::bad_mesh, reason, {file.string()});
}

[[noreturn]] void refuse_unread(const std::filesystem::path& file, const std::string& why) {
  const bool has_remedy = why.find("export") != why.npos || why.find("; write ") != why.npos ||
                          why.find("; save ") != why.npos || why.find("; choose ") != why.npos;
  refuse(file, fmt::format("cannot be read: {}{}", why, has_remedy ? "" : "; export it again, or as STL"));
}

ReadAttempt read_by_extension(const std::filesystem::path& file, double deflection, double metres,
                              std::optional<SpheresInside> inside) {
  const std::string extension = extension_of(file);
  if (extension == ".stl") return read_stl(file);
  if (extension == ".obj") return read_obj(file);
  if (extension == ".off" || extension == ".ply") return read_with_cgal(file);
  if (extension == ".3mf") return read_3mf(file);
  if (extension == ".amf") return read_amf(file);
  if (!opencascade_reads(file)) return read_with_assimp(file);
  constexpr double millimetre = 1e-3;
  const bool has_unit = !extension.starts_with(".br");
  const double unit = has_unit ? millimetre : metres;
  if (inside) inside->smallest_radius /= unit;
  return read_with_opencascade(file, deflection / unit, inside);
}

/// What was read, once it is known to be a surface.
ReadAttempt sound(ReadAttempt read, const std::filesystem::path& file) {
  if (!read.failed_option.empty())
    throw OptionError(read.failed_option, fmt::format("{}: {}", file.filename().string(), read.failure));
  if (!read.ok()) refuse_unread(file, read.failure);
  if (read.soup.polygons.empty()) refuse(file, "holds no faces; export the surface, not points or curves");
  if (const double farthest = largest_coordinate(read.soup); !(farthest <= most_coordinate))
    refuse(file,
           fmt::format("has a coordinate of {:g}, beyond {:g}; export it again", farthest, most_coordinate));
  const auto& widest =
      *std::ranges::max_element(read.soup.polygons, {}, [](const auto& p) { return p.size(); });
  if (widest.size() > most_corners_of_face)
    refuse(file, fmt::format("a face has {} corners, more than {}; export triangles", widest.size(),
                             most_corners_of_face));
  make_plain(read);
  return read;
}

/// Says which files the part consists of besides the given one.
void note_other_files(const std::filesystem::path& file, ReadAttempt& read) {
  constexpr std::size_t most = 6;
  std::vector<std::string> names;
  for (const std::filesystem::path& other : files_of_part(file))
    if (other != file) names.push_back(other.lexically_relative(file.parent_path()).string());
  if (names.empty()) return;
  const std::size_t more = names.size() - std::min(most, names.size());
  names.resize(names.size() - more);
  read.facts.notes.push_back(fmt::format("the file refers to others, which were read with it: {}{}",
                                         fmt::join(names, ", "),
                                         more > 0 ? fmt::format(" and {} more", more) : ""));
}

}  // namespace

ReadAttempt read_soup(const std::filesystem::path& file, double deflection, double metres,
                      const std::optional<SpheresInside>& inside) {
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::missing) refuse(file, "no such file");
  if (kind == FileKind::folder) refuse(file, "is a folder, not a file");
  if (kind == FileKind::other) refuse(file, "is a pipe or a device, not a regular file");
  std::error_code error;
  if (std::filesystem::file_size(file, error) == 0) refuse(file, "the file is empty");
  if (const std::string other = why_no_mesh(file); !other.empty()) refuse(file, other);
  ReadAttempt read = sound(read_by_extension(file, deflection, metres > 0 ? metres : 1, inside), file);
  note_other_files(file, read);
  return read;
}

ReadAttempt read_surface(const PolygonSurface& surface, const std::filesystem::path& name) {
  for (const Vector<3>& v : surface.vertices)
    if (!v.allFinite()) refuse(name, "a coordinate is not finite");
  for (const auto& face : surface.faces)
    if (face.size() < 3 || std::ranges::max(face) >= surface.vertices.size())
      refuse(name, fmt::format("a face has three or more of the vertices 0 to {}, not [{}]",
                               std::ptrdiff_t(surface.vertices.size()) - 1, fmt::join(face, ", ")));
  return sound({.soup = {surface.vertices, surface.faces}, .reader = "given, in double precision"}, name);
}

}  // namespace bernal::cad
