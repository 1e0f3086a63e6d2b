#include "mesh_files/poly_mesh.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

constexpr std::uint32_t none = TriangleSide::none;

void add_face(PolyMesh& poly, std::span<const std::uint32_t> corners, std::uint32_t owner) {
  poly.faces.add(corners);
  poly.owner.push_back(owner);
}

/// The faces that the cells in stacks of prisms share with each other.
class FacesOfStacks {
 public:
  explicit FacesOfStacks(const VolumeMesh& mesh)
      : mesh_(mesh),
        layers_(static_cast<std::uint32_t>(mesh.stacks.layers)),
        beside_(mesh.stacks.triangle.size()) {
    struct Edge {
      std::array<std::uint32_t, 2> ends;
      std::uint32_t stack;
      std::uint8_t side;
    };
    std::vector<Edge> edges;
    for (std::uint32_t s = 0; s < beside_.size(); ++s) {
      beside_[s].fill(none);
      const PrismCorners& c = mesh.stacks.prisms[std::size_t{s} * layers_];
      for (std::uint8_t side = 0; side < 3; ++side) {
        const std::uint32_t a = c[side], b = c[(side + 1U) % 3];
        edges.push_back({{std::min(a, b), std::max(a, b)}, s, side});
      }
    }
    std::ranges::sort(edges, {}, [](const Edge& e) { return std::tuple(e.ends, e.stack); });
    for (std::size_t i = 1; i < edges.size(); ++i) {
      const Edge &one = edges[i - 1], &other = edges[i];
      if (one.ends != other.ends) continue;
      beside_[one.stack][one.side] = other.stack;
      beside_[other.stack][other.side] = one.stack;
    }
  }

  /// Those that a prism owns.
  void add(std::uint32_t prism, PolyMesh& poly) const {
    const auto first = static_cast<std::uint32_t>(mesh_.tetrahedra.size());
    const std::uint32_t stack = prism / layers_, layer = prism % layers_;
    const PrismCorners& c = mesh_.stacks.prisms[prism];
    struct Face {
      std::uint32_t neighbour;
      std::vector<std::uint32_t> corners;
    };
    std::vector<Face> faces;
    if (layer + 1 < layers_) faces.push_back({prism + 1, {c[3], c[4], c[5]}});
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint32_t other = beside_[stack][side];
      if (other == none || other < stack) continue;
      std::vector<std::uint32_t> corners = {c[side], c[(side + 1) % 3]};
      for (const std::size_t k : {(side + 1) % 3, side})
        if (c[k] != c[k + 3]) corners.push_back(c[k + 3]);
      if (corners.size() > 2) faces.push_back({other * layers_ + layer, std::move(corners)});
    }
    std::ranges::sort(faces, {}, &Face::neighbour);
    for (const Face& face : faces) {
      add_face(poly, face.corners, first + prism);
      poly.neighbour.push_back(first + face.neighbour);
    }
  }

 private:
  const VolumeMesh& mesh_;
  std::uint32_t layers_;
  std::vector<std::array<std::uint32_t, 3>> beside_;  ///< the stack on the other side of each edge
};

using SidesOfTriangles = std::vector<std::array<TriangleSide, 2>>;

void add_inner_faces(const VolumeMesh& mesh, const SidesOfTriangles& sides, PolyMesh& poly) {
  auto behind = neighbours_of(mesh);
  const std::size_t tetrahedra = mesh.tetrahedra.size(), layers = mesh.stacks.layers;
  for (std::size_t s = 0; s < mesh.stacks.triangle.size(); ++s)
    for (const TriangleSide& on_top : sides[mesh.stacks.triangle[s]])
      if (on_top.is_there())
        behind[on_top.tetrahedron][on_top.face] =
            static_cast<std::uint32_t>(tetrahedra + (s + 1) * layers - 1);
  for (std::uint32_t t = 0; t < tetrahedra; ++t) {
    std::array<std::size_t, 4> order = {0, 1, 2, 3};
    std::ranges::sort(order, {}, [&](std::size_t k) { return behind[t][k]; });
    for (const std::size_t k : order) {
      if (behind[t][k] == none || behind[t][k] < t) continue;
      add_face(poly, face_of(mesh, t, k), t);
      poly.neighbour.push_back(behind[t][k]);
    }
  }
  const FacesOfStacks of_stacks(mesh);
  for (std::uint32_t p = 0; p < mesh.stacks.prisms.size(); ++p) of_stacks.add(p, poly);
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
  BoundaryFaces(const VolumeMesh& mesh, const MeshGroups& groups, const SidesOfTriangles& sides,
                PolyMesh& poly)
      : mesh_(mesh), groups_(groups), poly_(poly), sides_(sides) {
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
    PolyMesh::Patch patch{.name = name, .type = type_of_patch(groups_, surface), .first = poly_.faces.size()};
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
      if (const auto stack = std::ranges::lower_bound(mesh_.stacks.triangle, triangles[k]);
          stack != mesh_.stacks.triangle.end() && *stack == triangles[k]) {
        add_below_stack(static_cast<std::size_t>(stack - mesh_.stacks.triangle.begin()));
        continue;
      }
      const TriangleSide& side =
          sides_[triangles[k]][0].is_there() ? sides_[triangles[k]][0] : sides_[triangles[k]][1];
      FaceCorners corners = face_of(mesh_, side.tetrahedron, side.face);
      if (end != none) begin_at_image(end, k, corners);
      add_face(poly_, corners, side.tetrahedron);
    }
    patch.count = triangles.size();
    poly_.patches.push_back(patch);
  }

  void add_below_stack(std::size_t stack) {
    const std::size_t prism = stack * mesh_.stacks.layers;
    const PrismCorners& c = mesh_.stacks.prisms[prism];
    add_face(poly_, FaceCorners{c[0], c[2], c[1]},
             static_cast<std::uint32_t>(mesh_.tetrahedra.size() + prism));
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
  const SidesOfTriangles& sides_;
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
  const SidesOfTriangles sides = sides_of_triangles(mesh);
  add_inner_faces(mesh, sides, poly);
  BoundaryFaces(mesh, groups, sides, poly).add();
  poly.cells = mesh.tetrahedra.size() + mesh.stacks.prisms.size();
  return poly;
}

}  // namespace bernal
