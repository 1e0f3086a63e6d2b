#include "meshes/triangle_sides.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

/// The same triangle with its least corner first.
FaceCorners from_least(FaceCorners corners) {
  std::ranges::rotate(corners, std::ranges::min_element(corners));
  return corners;
}

[[noreturn]] void refuse(const VolumeMesh& mesh, std::size_t triangle) {
  const Vector<3> at = mesh.vertices[mesh.triangles[triangle][0]];
  throw Error(
      ErrorCode::bad_mesh,
      fmt::format("the mesh does not keep the surface near ({:.6g}, {:.6g}, {:.6g})", at[0], at[1], at[2]));
}

std::int32_t region_of(const VolumeMesh& mesh, std::size_t triangle, std::size_t side) {
  return mesh.patches[mesh.patch[triangle]].regions[side];
}

using Sides = std::vector<std::array<TriangleSide, 2>>;

/// What is there, whatever its region.
Sides found_sides(const VolumeMesh& mesh) {
  // Triangles by their least corner: those of vertex v stand from first[v] to first[v + 1].
  const auto least = [](const FaceCorners& c) { return std::min({c[0], c[1], c[2]}); };
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1, 0), sorted(mesh.triangles.size());
  for (const FaceCorners& triangle : mesh.triangles) ++first[least(triangle) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) sorted[next[least(mesh.triangles[t])]++] = t;
  Sides sides(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::uint8_t f = 0; f < 4; ++f) {
      FaceCorners c{};
      for (std::size_t k = 0; k < 3; ++k)
        c[k] = mesh.tetrahedra[t][static_cast<std::size_t>(faces_of_tetrahedron[f][k])];
      c = from_least(c);
      for (std::uint32_t k = first[c[0]]; k < first[c[0] + 1]; ++k) {
        const FaceCorners of = from_least(mesh.triangles[sorted[k]]);
        const bool is_same = of == c, is_turned = of[1] == c[2] && of[2] == c[1];
        if (!is_same && !is_turned) continue;
        const std::size_t side = is_same ? 0 : 1;
        TriangleSide& met = sides[sorted[k]][side];
        if (met.is_there()) refuse(mesh, sorted[k]);
        met = {t, f};
      }
    }
  return sides;
}

}  // namespace

std::vector<std::array<TriangleSide, 2>> sides_of_triangles(const VolumeMesh& mesh) {
  Sides sides = found_sides(mesh);
  for (std::size_t t = 0; t < sides.size(); ++t)
    for (std::size_t side = 0; side < 2; ++side) {
      const TriangleSide& at = sides[t][side];
      const std::int32_t found =
          at.is_there() ? static_cast<std::int32_t>(mesh.region[at.tetrahedron]) : SurfacePatch::nothing;
      if (found != region_of(mesh, t, side)) refuse(mesh, t);
    }
  return sides;
}

void take_regions_of_triangles(VolumeMesh& mesh) {
  const Sides sides = found_sides(mesh);
  std::vector<std::int32_t> region(1 + *std::ranges::max_element(mesh.region), SurfacePatch::nothing);
  for (std::size_t t = 0; t < sides.size(); ++t)
    for (std::size_t side = 0; side < 2; ++side)
      if (sides[t][side].is_there())
        region[mesh.region[sides[t][side].tetrahedron]] = region_of(mesh, t, side);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const std::int32_t of = region[mesh.region[t]];
    if (of == SurfacePatch::nothing)
      throw Error(ErrorCode::bad_mesh, "tetrahedra were made where no region is: is the surface closed?");
    mesh.region[t] = static_cast<std::uint32_t>(of);
  }
}

}  // namespace bernal
