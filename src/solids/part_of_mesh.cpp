// The convex part that the triangles of a mesh bound.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "geometry/measures.hpp"
#include "geometry/topology.hpp"
#include "solids/flat_faces.hpp"
#include "solids/part_maker.hpp"

namespace bernal {
namespace {

/// Of each coordinate in a file, and of the extent of its part.
constexpr double rounding_in_files = 2e-7, rounding_of_extent = 1e-6;
/// Every corner is held against every face.
constexpr std::size_t most_faces_of_part = 2000;

class PlanesOfMesh {
 public:
  PlanesOfMesh(const Mesh& mesh, double tolerance)
      : mesh_(mesh),
        tolerance_(tolerance),
        topology_(topology_of(mesh)),
        groups_(flat_groups_of(mesh, topology_, tolerance)),
        at_(mesh.vertices.size()) {
    require_closed();
    number_in_order();
    if (groups_.members.size() > most_faces_of_part)
      refuse_part(
          fmt::format("has {} flat faces, and {} are taken at most: leave out roundings, or export "
                      "it with a coarser tolerance",
                      groups_.members.size(), most_faces_of_part));
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t corner : mesh.triangles[t]) {
        std::vector<std::uint32_t>& of = at_[corner];
        if (std::ranges::find(of, groups_.of_triangle[t]) == of.end()) of.push_back(groups_.of_triangle[t]);
      }
    for (const std::vector<std::uint32_t>& members : groups_.members) planes_.push_back(plane_of(members));
    require_convex();
  }

  ConvexPart part() && {
    PartMaker maker(std::move(planes_));
    for (std::size_t v = 0; v < at_.size(); ++v)
      if (at_[v].size() >= 3) maker.add_corner(mesh_.vertices[v], std::move(at_[v]));
    return std::move(maker).made(tolerance_);
  }

 private:
  void require_closed() const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (topology_.neighbor[t][k] == no_index)
          refuse_part(fmt::format("is not closed at {}", place_in_part(middle_of_side(t, k))));
  }

  /// Numbers groups in the order in which the triangles first name them.
  void number_in_order() {
    std::vector<std::uint32_t> number(groups_.members.size(), no_index);
    std::vector<std::vector<std::uint32_t>> members;
    for (std::uint32_t& group : groups_.of_triangle) {
      if (number[group] == no_index) {
        number[group] = static_cast<std::uint32_t>(members.size());
        members.push_back(std::move(groups_.members[group]));
      }
      group = number[group];
    }
    groups_.members = std::move(members);
  }

  Vector<3> middle_of_side(std::size_t triangle, std::size_t side) const {
    const FaceCorners& corners = mesh_.triangles[triangle];
    return 0.5 * (mesh_.vertices[corners[side]] + mesh_.vertices[corners[(side + 1) % 3]]);
  }

  HalfSpace plane_of(const std::vector<std::uint32_t>& members) const {
    HalfSpace plane;
    plane.normal.setZero();
    Bounds<3> around = Bounds<3>::of_nothing();
    double sum = 0;
    for (const std::uint32_t t : members) plane.normal += doubled_area(mesh_, mesh_.triangles[t]);
    plane.normal.normalize();
    for (const std::uint32_t t : members)
      for (const std::uint32_t corner : mesh_.triangles[t]) around.add(mesh_.vertices[corner]);
    for (int k = 0; k < 3; ++k)
      if (around.lower[k] == around.upper[k]) {
        const double side = plane.normal[k] > 0 ? 1 : -1;
        return {side * Vector<3>::Unit(k), side * around.lower[k]};
      }
    for (const std::uint32_t t : members)
      for (const std::uint32_t corner : mesh_.triangles[t]) sum += plane.normal.dot(mesh_.vertices[corner]);
    plane.offset = sum / (3 * static_cast<double>(members.size()));
    return plane;
  }

  void require_convex() const {
    for (std::uint32_t f = 0; f < planes_.size(); ++f)
      for (std::size_t v = 0; v < at_.size(); ++v)
        if (!at_[v].empty() && rise(f, static_cast<std::uint32_t>(v)) > 2 * tolerance_)
          refuse_part(
              fmt::format("is not convex at {}", place_in_part(hollow_of(f).value_or(mesh_.vertices[v]))));
  }

  double rise(std::uint32_t plane, std::uint32_t vertex) const {
    return planes_[plane].normal.dot(mesh_.vertices[vertex]) - planes_[plane].offset;
  }

  /// The middle of the side of a face at which the surface rises above its plane.
  std::optional<Vector<3>> hollow_of(std::uint32_t face) const {
    std::optional<Vector<3>> found;
    double most = 2 * tolerance_;
    for (const std::uint32_t t : groups_.members[face])
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t beside = topology_.neighbor[t][k];
        if (groups_.of_triangle[beside] == face) continue;
        for (const std::uint32_t corner : mesh_.triangles[beside])
          if (const double above = rise(face, corner); above > most) {
            most = above;
            found = middle_of_side(t, k);
          }
      }
    return found;
  }

  const Mesh& mesh_;
  double tolerance_;
  MeshTopology topology_;
  FlatGroups groups_;
  std::vector<std::vector<std::uint32_t>> at_;  ///< faces, by vertex
  std::vector<HalfSpace> planes_;
};

}  // namespace

ConvexPart part_bounded_by(const Mesh& mesh) {
  const Bounds<3> around = bounds_of_faces(mesh);
  if (mesh.triangles.empty() || !(around.diagonal() > 0)) refuse_part("holds nothing");
  const double farthest = std::max(around.lower.cwiseAbs().maxCoeff(), around.upper.cwiseAbs().maxCoeff());
  return PlanesOfMesh(mesh, rounding_of_extent * around.diagonal() + rounding_in_files * farthest).part();
}

}  // namespace bernal
