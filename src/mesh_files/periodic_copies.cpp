#include "mesh_files/periodic_copies.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace bernal {
namespace {

/// A vertex of the mesh in an image of the period.
struct ImageVertex {
  std::uint32_t vertex = 0;
  std::array<int, 3> image = {};
  auto operator<=>(const ImageVertex&) const = default;
};

/// Names images by vertices that lie in no upper end of a period.
class LowestNames {
 public:
  explicit LowestNames(const VolumeMesh& mesh) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower_[axis].resize(mesh.vertices.size());
      std::iota(lower_[axis].begin(), lower_[axis].end(), 0U);
      for (const auto& [low, high] : mesh.periodic[axis])
        if (high < lower_[axis].size()) lower_[axis][high] = low;
    }
  }
  ImageVertex operator()(ImageVertex of) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const std::uint32_t low = lower_[axis][of.vertex]; low != of.vertex) {
        of.vertex = low;
        ++of.image[axis];
      }
    return of;
  }

 private:
  std::array<std::vector<std::uint32_t>, 3> lower_;
};

}  // namespace

bool is_end_of_period(const SurfacePatch& patch, const Boundary<3>& boundary) {
  return patch.kind == SurfacePatch::Kind::period_end && boundary.repeats(static_cast<int>(patch.index / 2));
}

OpenSurface with_periodic_copies(const VolumeMesh& mesh, const Boundary<3>& boundary, double margin) {
  OpenSurface made{.vertices = mesh.vertices, .triangles = {}, .triangle = {}};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (is_end_of_period(mesh.patches[mesh.patch[t]], boundary)) continue;
    made.triangles.push_back(mesh.triangles[t]);
    made.triangle.push_back(t);
  }
  if (!boundary.repeats(0) && !boundary.repeats(1) && !boundary.repeats(2)) return made;
  const std::size_t own = made.triangles.size();
  const LowestNames name(mesh);
  std::map<ImageVertex, std::uint32_t> known;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) known.emplace(name({v, {}}), v);
  std::array<int, 3> step;
  const auto reaches = [&](const FaceCorners& corners) {
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      const double shift = step[static_cast<std::size_t>(k)] * boundary.edges[k] - boundary.origin[k];
      const auto at = [&](std::size_t c) { return mesh.vertices[corners[c]][k] + shift; };
      if (std::min({at(0), at(1), at(2)}) > boundary.edges[k] + margin ||
          std::max({at(0), at(1), at(2)}) < -margin)
        return false;
    }
    return true;
  };
  const auto image_of = [&](std::uint32_t v) {
    const auto [entry, is_new] =
        known.try_emplace(name({v, step}), static_cast<std::uint32_t>(made.vertices.size()));
    if (is_new) {
      const auto& [vertex, image] = entry->first;
      Vector<3> place = mesh.vertices[vertex];
      for (int k = 0; k < 3; ++k)
        if (image[static_cast<std::size_t>(k)] != 0)
          place[k] += image[static_cast<std::size_t>(k)] * boundary.edges[k];
      made.vertices.push_back(place);
    }
    return entry->second;
  };
  const auto most = [&](int axis) { return boundary.repeats(axis) ? 1 : 0; };
  for (step[0] = -most(0); step[0] <= most(0); ++step[0])
    for (step[1] = -most(1); step[1] <= most(1); ++step[1])
      for (step[2] = -most(2); step[2] <= most(2); ++step[2]) {
        if (step == std::array<int, 3>{}) continue;
        for (std::size_t t = 0; t < own; ++t) {
          FaceCorners corners = made.triangles[t];
          if (!reaches(corners)) continue;
          for (std::uint32_t& corner : corners) corner = image_of(corner);
          made.triangles.push_back(corners);
          made.triangle.push_back(made.triangle[t]);
        }
      }
  return made;
}

}  // namespace bernal
