#include "cad/read_soup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "cad/known_formats.hpp"
#include "cad/point_cubes.hpp"
#include "cad/stl_file.hpp"
#include "core/file_kind.hpp"

namespace bernal::cad {

namespace {

/// Its triangles reach across each other's boxes, so that to look for crossings takes a time that grows as
/// the square: 10 s for 20,000 corners, a minute for these.
constexpr std::size_t most_corners_of_face = 50'000;
/// Products of more are no numbers, which exact arithmetic does not forgive.
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

/// How far a corner of one soup is from that of the other at most, polygon by polygon in their order;
/// infinity if they do not have the same polygons.
double difference(const PolygonSoup& one, const PolygonSoup& other) {
  if (one.polygons.size() != other.polygons.size()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < one.polygons.size(); ++i) {
    const auto &p = one.polygons[i], &q = other.polygons[i];
    if (p.size() != q.size()) return std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < p.size(); ++k)
      largest = std::max(largest, (one.points[p[k]] - other.points[q[k]]).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// The same where one of the readers puts the polygons into another order: whether every corner of each soup
/// has one of the other within `tolerance`.
bool same_corners(const PolygonSoup& one, const PolygonSoup& other, double tolerance) {
  if (one.polygons.size() != other.polygons.size()) return false;
  const auto covers = [&](const PolygonSoup& these, const PolygonSoup& those) {
    PointCubes cubes(4 * tolerance);
    for (const auto& polygon : these.polygons)
      for (const std::uint32_t v : polygon) cubes.add(v, these.points[v]);
    const Vector<3> reach = Vector<3>::Constant(tolerance);
    for (const auto& polygon : those.polygons)
      for (const std::uint32_t v : polygon) {
        const Vector<3>& p = those.points[v];
        bool found = false;
        cubes.each_in(p - reach, p + reach, [&](std::uint32_t near) {
          found = found || (these.points[near] - p).cwiseAbs().maxCoeff() <= tolerance;
        });
        if (!found) return false;
      }
    return true;
  };
  return covers(one, other) && covers(other, one);
}

double largest_coordinate(const PolygonSoup& soup) {
  double largest = 0;
  for (const auto& polygon : soup.polygons)
    for (const std::uint32_t v : polygon) largest = std::max(largest, soup.points[v].cwiseAbs().maxCoeff());
  return largest;
}

enum class Agreement { none, in_order, in_another_order };

/// Whether the soups are the same to single precision (the last digit of a parsed float may be off by a few
/// units), corner by corner.
Agreement agreement(const PolygonSoup& in_float, const PolygonSoup& in_double) {
  const double rounding = 4.0 * std::numeric_limits<float>::epsilon() * largest_coordinate(in_double);
  if (difference(in_float, in_double) <= rounding) return Agreement::in_order;
  const bool same = rounding > 0 && same_corners(in_float, in_double, rounding);
  return same ? Agreement::in_another_order : Agreement::none;
}

/// What a file says of itself goes to terminals and pages.
void make_plain(ChosenSoup& read) {
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

/// OFF and PLY say in front how much they hold, and CGAL holds them to it; assimp bends indices that are out
/// of range until they fit.
bool cgal_is_strict(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".off" || extension == ".ply";
}

ChosenSoup chosen(ReadAttempt&& attempt, std::string reader) {
  return {std::move(attempt.soup), std::move(reader), std::move(attempt.facts)};
}

/// Two readers saw the file: assimp is right about what there is, CGAL keeps the doubles.
ChosenSoup choose(const std::filesystem::path& file, ReadAttempt assimp, ReadAttempt cgal) {
  if (!assimp.ok() && !cgal.ok())
    refuse_unread(file, fmt::format("{} (assimp), {} (CGAL)", assimp.failure, cgal.failure));
  if (!cgal.ok())
    return chosen(std::move(assimp), fmt::format("assimp, single precision (CGAL: {})", cgal.failure));
  if (!assimp.ok())
    return chosen(std::move(cgal), fmt::format("CGAL, double precision (assimp: {})", assimp.failure));
  if (const Agreement found = agreement(assimp.soup, cgal.soup); found != Agreement::none) {
    // The names of the parts are assimp's, if it left the polygons in their order.
    if (cgal.soup.solids.empty() && found == Agreement::in_order)
      cgal.soup.solids = std::move(assimp.soup.solids);
    cgal.facts = std::move(assimp.facts);
    return chosen(std::move(cgal), "CGAL, double precision (assimp agrees to single precision)");
  }
  const auto disagreement = [](std::string_view who, const PolygonSoup& other, const PolygonSoup& taken) {
    if (other.polygons.size() == taken.polygons.size()) return fmt::format("({} has other corners)", who);
    return fmt::format("({} disagrees: {} faces against {})", who, other.polygons.size(),
                       taken.polygons.size());
  };
  if (extension_of(file) == ".off") {  // of which assimp leaves out the faces of ten corners and more
    const std::string text = disagreement("assimp", assimp.soup, cgal.soup);
    return chosen(std::move(cgal), "CGAL, double precision " + text);
  }
  const std::string text = disagreement("CGAL", cgal.soup, assimp.soup);
  return chosen(std::move(assimp), "assimp, single precision " + text);
}

ChosenSoup read_by_extension(const std::filesystem::path& file, double deflection, double metres) {
  constexpr double millimetre = 1e-3;
  if (extension_of(file) == ".stl") {
    const StlFile stl = read_stl_file(file);
    ReadAttempt assimp = read_stl_with_assimp(stl.content);
    tell_parts(stl, assimp);
    if (!stl.binary) {
      ReadAttempt cgal = read_stl_with_cgal(stl.content);
      tell_parts(stl, cgal);
      return choose(file, std::move(assimp), std::move(cgal));
    }
    if (!assimp.ok()) refuse_unread(file, assimp.failure);
    return chosen(std::move(assimp), "assimp (binary STL holds single precision)");
  }
  if (opencascade_reads(file)) {
    const bool has_unit = !extension_of(file).starts_with(".br");
    ReadAttempt read = read_with_opencascade(file, deflection / (has_unit ? millimetre : metres));
    if (!read.ok()) refuse_unread(file, read.failure);
    return chosen(std::move(read), "OpenCASCADE, tessellated");
  }
  if (cgal_reads(file)) {
    if (extension_of(file) == ".obj")
      if (const std::string wrong = wrong_number_of_obj(file); !wrong.empty()) refuse_unread(file, wrong);
    ReadAttempt cgal = read_with_cgal(file);
    if (!cgal.ok() && cgal_is_strict(file)) refuse_unread(file, cgal.failure);
    return choose(file, read_with_assimp(file), std::move(cgal));
  }
  if (const std::string extension = extension_of(file); extension == ".3mf" || extension == ".amf") {
    ReadAttempt read = extension == ".3mf" ? read_3mf(file) : read_amf(file);
    if (!read.ok()) refuse_unread(file, read.failure);
    return chosen(std::move(read), "pugixml, double precision");
  }
  ReadAttempt assimp = read_with_assimp(file);
  if (!assimp.ok()) refuse_unread(file, assimp.failure);
  return chosen(std::move(assimp), "assimp, single precision");
}

}  // namespace

ChosenSoup read_soup(const std::filesystem::path& file, double deflection, double metres) {
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::missing) refuse(file, "no such file");
  if (kind == FileKind::folder) refuse(file, "is a folder, not a file");
  if (kind == FileKind::other) refuse(file, "is a pipe or a device, not a regular file");
  std::error_code error;
  if (std::filesystem::file_size(file, error) == 0) refuse(file, "the file is empty");
  if (const std::string other = known_not_to_be_a_mesh(file); !other.empty()) refuse(file, other);
  ChosenSoup read = read_by_extension(file, deflection, metres > 0 ? metres : 1);
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

}  // namespace bernal::cad
