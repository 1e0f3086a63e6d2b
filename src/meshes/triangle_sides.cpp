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

/// The triangles on top of stacks of prisms in the place of those below.
std::vector<FaceCorners> triangles_on_top(const VolumeMesh& mesh) {
  std::vector<FaceCorners> triangles = mesh.triangles;
  for (std::size_t s = 0; s < mesh.stacks.triangle.size(); ++s) {
    FaceCorners& triangle = triangles[mesh.stacks.triangle[s]];
    const PrismCorners &low = mesh.stacks.prisms[s * mesh.stacks.layers], &high = mesh.stacks.top(s);
    for (std::uint32_t& corner : triangle)
      for (std::size_t k = 0; k < 3; ++k)
        if (low[k] == corner) {
          corner = high[k + 3];
          break;
        }
  }
  return triangles;
}

}  // namespace

std::vector<std::array<TriangleSide, 2>> found_sides(const VolumeMesh& mesh) {
  const std::vector<FaceCorners> on_top =
      mesh.stacks.empty() ? std::vector<FaceCorners>() : triangles_on_top(mesh);
  const std::vector<FaceCorners>& triangles = mesh.stacks.empty() ? mesh.triangles : on_top;
  // Triangles by their least corner: those of vertex v stand from first[v] to first[v + 1].
  const auto least = [](const FaceCorners& c) { return std::min({c[0], c[1], c[2]}); };
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1, 0), sorted(triangles.size());
  for (const FaceCorners& triangle : triangles) ++first[least(triangle) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) sorted[next[least(triangles[t])]++] = t;
  std::vector<std::array<TriangleSide, 2>> sides(triangles.size());
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (std::uint8_t f = 0; f < 4; ++f) {
      const FaceCorners c = from_least(face_of(mesh, t, f));
      for (std::uint32_t k = first[c[0]]; k < first[c[0] + 1]; ++k) {
        const FaceCorners of = from_least(triangles[sorted[k]]);
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

std::vector<std::array<TriangleSide, 2>> sides_of_triangles(const VolumeMesh& mesh) {
  std::vector<std::array<TriangleSide, 2>> sides = found_sides(mesh);
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
  const std::vector<std::array<TriangleSide, 2>> sides = found_sides(mesh);
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

FaceCorners face_of(const VolumeMesh& mesh, std::size_t t, std::size_t k) {
  FaceCorners corners{};
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = mesh.tetrahedra[t][static_cast<std::size_t>(faces_of_tetrahedron[k][i])];
  return corners;
}

std::vector<std::array<std::uint32_t, 4>> neighbours_of(const VolumeMesh& mesh) {
  // Faces by their least corner: those of vertex v stand from first[v] to first[v + 1].
  const std::size_t cells = mesh.tetrahedra.size();
  const auto least = [](const FaceCorners& c) { return std::min({c[0], c[1], c[2]}); };
  std::vector<std::size_t> first(mesh.vertices.size() + 1, 0);
  for (std::size_t t = 0; t < cells; ++t)
    for (std::size_t k = 0; k < 4; ++k) ++first[least(face_of(mesh, t, k)) + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::size_t> next(first.begin(), first.end() - 1), sorted(4 * cells);
  for (std::size_t t = 0; t < cells; ++t)
    for (std::size_t k = 0; k < 4; ++k) sorted[next[least(face_of(mesh, t, k))]++] = 4 * t + k;
  std::vector<std::array<std::uint32_t, 4>> behind(
      cells, {TriangleSide::none, TriangleSide::none, TriangleSide::none, TriangleSide::none});
  struct Entry {
    std::array<std::uint32_t, 2> others;
    std::size_t face;
  };
  std::vector<Entry> at;
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    at.clear();
    for (std::size_t i = first[v]; i < first[v + 1]; ++i) {
      FaceCorners corners = face_of(mesh, sorted[i] / 4, sorted[i] % 4);
      std::ranges::sort(corners);
      at.push_back({{corners[1], corners[2]}, sorted[i]});
    }
    std::ranges::sort(at, {}, [](const Entry& e) { return std::pair(e.others, e.face); });
    for (std::size_t i = 1; i < at.size(); ++i) {
      if (at[i].others != at[i - 1].others) continue;
      behind[at[i].face / 4][at[i].face % 4] = static_cast<std::uint32_t>(at[i - 1].face / 4);
      behind[at[i - 1].face / 4][at[i - 1].face % 4] = static_cast<std::uint32_t>(at[i].face / 4);
    }
  }
  return behind;
}

}  // namespace bernal
