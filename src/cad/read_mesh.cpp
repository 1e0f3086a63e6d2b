#include "bernal/cad/read_mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bernal/core/error.hpp"
#include "cad/diagnose_mesh.hpp"
#include "cad/file_facts.hpp"
#include "cad/make_triangles.hpp"
#include "cad/polygon_soup.hpp"
#include "cad/stl_file.hpp"

namespace bernal {
namespace {

using cad::PolygonSoup;
using cad::ReadAttempt;

struct ChosenSoup {
  PolygonSoup soup;
  std::string reader;
};

Bounds<3> bounds_of_polygons(const PolygonSoup& soup) {
  const double infinity = std::numeric_limits<double>::infinity();
  Bounds<3> bounds{Vector<3>::Constant(infinity), Vector<3>::Constant(-infinity)};
  for (const auto& polygon : soup.polygons) {
    for (const std::uint32_t i : polygon) {
      bounds.lower = bounds.lower.cwiseMin(soup.points[i]);
      bounds.upper = bounds.upper.cwiseMax(soup.points[i]);
    }
  }
  return bounds;
}

/// Whether the soups are the same to single precision: as many faces, and bounds that differ by no more than
/// the rounding of a parsed float (its last digit may be off by a few units).
bool agree(const PolygonSoup& in_float, const PolygonSoup& in_double) {
  if (in_float.polygons.size() != in_double.polygons.size()) return false;
  if (in_float.polygons.empty()) return true;
  const Bounds<3> a = bounds_of_polygons(in_float), b = bounds_of_polygons(in_double);
  const double largest = std::max(b.lower.cwiseAbs().maxCoeff(), b.upper.cwiseAbs().maxCoeff());
  const double rounding = 4.0 * std::numeric_limits<float>::epsilon() * largest;
  return (a.lower - b.lower).cwiseAbs().maxCoeff() <= rounding &&
         (a.upper - b.upper).cwiseAbs().maxCoeff() <= rounding;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& reason) {
  throw Error(ErrorCode::bad_mesh, reason, {file.string()});
}

/// OFF and PLY say in front how much they hold, and CGAL holds them to it; assimp bends indices that are out
/// of range until they fit.
bool cgal_is_strict(const std::filesystem::path& file) {
  const std::string extension = cad::extension_of(file);
  return extension == ".off" || extension == ".ply";
}

/// Two readers saw the file: assimp is right about what there is, CGAL keeps the doubles.
ChosenSoup choose(const std::filesystem::path& file, ReadAttempt assimp, ReadAttempt cgal) {
  if (!assimp.ok() && !cgal.ok())
    refuse(file, fmt::format("cannot be read: {} (assimp), {} (CGAL)", assimp.failure, cgal.failure));
  if (!cgal.ok() && cgal_is_strict(file)) refuse(file, fmt::format("cannot be read: {}", cgal.failure));
  if (!cgal.ok())
    return {std::move(assimp.soup), fmt::format("assimp, single precision (CGAL: {})", cgal.failure)};
  if (!assimp.ok())
    return {std::move(cgal.soup), fmt::format("CGAL, double precision (assimp: {})", assimp.failure)};
  if (agree(assimp.soup, cgal.soup))
    return {std::move(cgal.soup), "CGAL, double precision (assimp agrees to single precision)"};
  const auto disagreement = [](std::string_view who, const PolygonSoup& other, const PolygonSoup& taken) {
    return fmt::format("({} disagrees: {} faces against {})", who, other.polygons.size(),
                       taken.polygons.size());
  };
  if (cad::extension_of(file) == ".off") {  // of which assimp leaves out the faces of ten corners and more
    const std::string text = disagreement("assimp", assimp.soup, cgal.soup);
    return {std::move(cgal.soup), "CGAL, double precision " + text};
  }
  const std::string text = disagreement("CGAL", cgal.soup, assimp.soup);
  return {std::move(assimp.soup), "assimp, single precision " + text};
}

ChosenSoup read_soup(const std::filesystem::path& file) {
  if (cad::extension_of(file) == ".stl") {
    const cad::StlFile stl = cad::read_stl_file(file);
    ReadAttempt assimp = cad::read_stl_with_assimp(stl.content);
    cad::tell_parts(stl, assimp);
    if (!stl.binary) {
      ReadAttempt cgal = cad::read_stl_with_cgal(stl.content);
      cad::tell_parts(stl, cgal);
      return choose(file, std::move(assimp), std::move(cgal));
    }
    if (!assimp.ok()) refuse(file, "cannot be read: " + assimp.failure);
    return {std::move(assimp.soup), "assimp (binary STL holds single precision)"};
  }
  if (cad::opencascade_reads(file)) {
    ReadAttempt step = cad::read_with_opencascade(file, 0);
    if (!step.ok()) refuse(file, "cannot be read: " + step.failure);
    return {std::move(step.soup), "OpenCASCADE"};
  }
  ReadAttempt assimp = cad::read_with_assimp(file);
  if (cad::cgal_reads(file)) return choose(file, std::move(assimp), cad::read_with_cgal(file));
  if (!assimp.ok()) refuse(file, "cannot be read: " + assimp.failure);
  return {std::move(assimp.soup), "assimp, single precision"};
}

/// What the user can do about the first of the report's problems.
std::string_view remedy(const MeshReport& report) {
  if (report.open_edges > 0) return "the surface has a hole or is a shell; close it in CAD";
  if (report.non_manifold_edges > 0)
    return "walls branch; unite touching bodies and delete inner faces in CAD";
  if (report.degenerate_faces > 0) return "export it again with a finer tolerance or collapse those faces";
  if (report.self_intersections > 0) return "the wall passes through itself; unite the bodies in CAD";
  return "export a closed solid";
}

}  // namespace

ImportedMesh read_mesh(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) refuse(file, "no such file");
  if (!std::filesystem::is_regular_file(file, error)) refuse(file, "not a regular file");
  if (std::filesystem::file_size(file, error) == 0) refuse(file, "the file is empty");

  const std::string other = cad::known_not_to_be_a_mesh(file);
  if (!other.empty()) refuse(file, other);

  ChosenSoup chosen = read_soup(file);
  if (chosen.soup.polygons.empty()) refuse(file, "holds no faces; export the surface, not points or curves");
  cad::Triangles triangles = cad::make_triangles(chosen.soup);
  chosen.soup = {};

  ImportedMesh result;
  result.report = cad::diagnose_mesh(triangles);
  result.report.reader = std::move(chosen.reader);
  result.mesh = std::move(triangles.mesh);
  return result;
}

ImportedMesh read_container_mesh(const std::filesystem::path& file, double factor) {
  if (!(factor > 0) || !std::isfinite(factor))
    throw Error(ErrorCode::bad_argument, fmt::format("unit factor {} is not a positive number", factor));
  ImportedMesh result = read_mesh(file);
  const MeshReport& report = result.report;
  if (!report.usable())
    refuse(file,
           fmt::format("cannot be a container: {} ({})", fmt::join(report.problems, ", "), remedy(report)));
  for (Vector<3>& v : result.mesh.vertices) v *= factor;
  return result;
}

}  // namespace bernal
