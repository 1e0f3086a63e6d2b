#include "mesh_files/poly_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

constexpr std::uint32_t none = TriangleSide::none;

void add_inner_faces(const VolumeMesh& mesh, PolyMesh& poly) {
  const auto behind = neighbours_of(mesh);
  for (std::uint32_t t = 0; t < behind.size(); ++t) {
    std::array<std::size_t, 4> order = {0, 1, 2, 3};
    std::ranges::sort(order, {}, [&](std::size_t k) { return behind[t][k]; });
    for (const std::size_t k : order) {
      if (behind[t][k] == none || behind[t][k] < t) continue;
      poly.faces.push_back(face_of(mesh, t, k));
      poly.owner.push_back(t);
      poly.neighbour.push_back(behind[t][k]);
    }
  }
}

/// The end of a period that a surface is, 0 to 5; none if it is no such.
std::uint32_t end_of(const VolumeMesh& mesh, std::uint32_t triangle) {
  const SurfacePatch& patch = mesh.patches[mesh.patch[triangle]];
  return patch.kind == SurfacePatch::Kind::period_end ? patch.index : none;
}

/// The triangles of the upper end that are images of those of the lower end, in their order, with corners
/// from the image of the first one, in opposite turns.
std::vector<std::uint32_t> images_of(const VolumeMesh& mesh, std::size_t axis,
                                     const std::vector<std::uint32_t>& lower,
                                     const std::vector<std::uint32_t>& upper) {
  std::vector<std::uint32_t> image(mesh.vertices.size(), none);
  for (const auto& [low, high] : mesh.periodic[axis])
    if (low < image.size()) image[low] = high;
  std::map<FaceCorners, std::uint32_t> by_corners;
  for (const std::uint32_t t : upper) {
    FaceCorners corners = mesh.triangles[t];
    std::ranges::sort(corners);
    by_corners[corners] = t;
  }
  std::vector<std::uint32_t> ordered;
  for (const std::uint32_t t : lower) {
    FaceCorners corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = image[mesh.triangles[t][k]];
    std::ranges::sort(corners);
    const auto found = by_corners.find(corners);
    if (found == by_corners.end())
      throw Error(ErrorCode::bad_mesh,
                  fmt::format("the ends of the period along {} are not images of each other",
                              std::string_view("xyz").substr(axis, 1)));
    ordered.push_back(found->second);
  }
  return ordered;
}

class BoundaryFaces {
 public:
  BoundaryFaces(const VolumeMesh& mesh, const MeshGroups& groups, PolyMesh& poly)
      : mesh_(mesh), groups_(groups), poly_(poly), sides_(sides_of_triangles(mesh)) {
    of_surface_ = by_group(mesh.triangles.size(), groups.surfaces.size(),
                           [&](std::size_t t) { return groups.surface_of(mesh, t); });
    // Those between two regions are inner faces.
    for (auto& triangles : of_surface_)
      std::erase_if(triangles,
                    [&](std::uint32_t t) { return sides_[t][0].is_there() == sides_[t][1].is_there(); });
  }

  void add() {
    for (std::uint32_t s = 0; s < of_surface_.size(); ++s)
      if (!of_surface_[s].empty()) add_surface(s);
  }

 private:
  void add_surface(std::uint32_t surface) {
    const std::uint32_t end = end_of(mesh_, of_surface_[surface].front());
    const std::string& name = groups_.surfaces[surface];
    PolyMesh::Patch patch{.name = name, .type = type_of_patch(name), .first = poly_.faces.size()};
    std::vector<std::uint32_t> triangles = of_surface_[surface];
    if (end != none) {
      const std::size_t axis = end / 2;
      const std::uint32_t other = groups_.surface_named(name_of_end(end ^ 1));
      patch.type = "cyclic";
      patch.neighbour = groups_.surfaces[other];
      const auto& [low, high] = mesh_.periodic[axis].front();
      patch.separation = mesh_.vertices[high] - mesh_.vertices[low];
      if (end % 2 == 1) {
        patch.separation = -patch.separation;
        triangles = images_of(mesh_, axis, of_surface_[other], triangles);
      }
    }
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      const TriangleSide& side =
          sides_[triangles[k]][0].is_there() ? sides_[triangles[k]][0] : sides_[triangles[k]][1];
      FaceCorners corners = face_of(mesh_, side.tetrahedron, side.face);
      if (end != none) begin_at_image(end, k, corners);
      poly_.faces.push_back(corners);
      poly_.owner.push_back(side.tetrahedron);
    }
    patch.count = triangles.size();
    poly_.patches.push_back(patch);
  }

  /// The first corner of the k-th face of a lower end is the least one, and at the upper end its image.
  void begin_at_image(std::uint32_t end, std::size_t k, FaceCorners& corners) const {
    const std::size_t axis = end / 2;
    const std::uint32_t lower = of_surface_[groups_.surface_named(name_of_end(end & ~1U))][k];
    const std::uint32_t begin = *std::ranges::min_element(mesh_.triangles[lower]);
    const auto is_first = [&](std::uint32_t corner) {
      if (end % 2 == 0) return corner == begin;
      Vector<3> off = mesh_.vertices[corner] - mesh_.vertices[begin];
      off[static_cast<int>(axis)] = 0;
      return off == Vector<3>::Zero();
    };
    std::ranges::rotate(corners, std::ranges::find_if(corners, is_first));
  }

  const VolumeMesh& mesh_;
  const MeshGroups& groups_;
  PolyMesh& poly_;
  std::vector<std::array<TriangleSide, 2>> sides_;
  std::vector<std::vector<std::uint32_t>> of_surface_;
};

}  // namespace

std::size_t PolyMesh::face_between(std::uint32_t cell, std::uint32_t other) const {
  const auto inner = owner.begin() + static_cast<std::ptrdiff_t>(neighbour.size());
  const auto [first, last] = std::equal_range(owner.begin(), inner, std::min(cell, other));
  const auto at = [&](auto of) { return neighbour.begin() + (of - owner.begin()); };
  return static_cast<std::size_t>(std::lower_bound(at(first), at(last), std::max(cell, other)) -
                                  neighbour.begin());
}

PolyMesh poly_mesh_of(const VolumeMesh& mesh, const MeshGroups& groups) {
  PolyMesh poly;
  add_inner_faces(mesh, poly);
  BoundaryFaces(mesh, groups, poly).add();
  return poly;
}

}  // namespace bernal
