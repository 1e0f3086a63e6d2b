// Prisms below the surface that tetrahedra begin at.
#include <algorithm>

#include "bernal/core/error.hpp"
#include "meshes/boundary_layer.hpp"

namespace bernal {
namespace {

bool has_column(const std::vector<Vector<3>>& columns, std::uint32_t v) {
  return columns[v] != Vector<3>::Zero();
}

/// Puts stacks of prisms between the surface and the tetrahedra, which begin at its raised vertices.
void add_stacks(const ConformingSurface& surface, const std::vector<Vector<3>>& columns,
                const BoundaryLayerOptions& options, VolumeMesh& mesh) {
  const std::vector<double> shares = shares_of_layers(options);
  mesh.stacks.layers = shares.size();
  const auto count = static_cast<std::uint32_t>(surface.vertices.size());
  std::vector<std::uint32_t> first_above(count, 0);  // those above it follow each other
  for (std::uint32_t v = 0; v < count; ++v) {
    if (!has_column(columns, v)) continue;
    const Vector<3> top = mesh.vertices[v];
    mesh.vertices[v] = surface.vertices[v];
    first_above[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t k = 0; k + 1 < shares.size(); ++k)
      mesh.vertices.emplace_back(surface.vertices[v] + shares[k] * columns[v]);
    mesh.vertices.push_back(top);
  }
  const auto above = [&](std::uint32_t v, std::size_t layers) {
    return layers == 0 || !has_column(columns, v) ? v
                                                  : first_above[v] + static_cast<std::uint32_t>(layers - 1);
  };
  for (TetrahedronCorners& corners : mesh.tetrahedra)
    for (std::uint32_t& v : corners)
      if (v < count) v = above(v, shares.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    FaceCorners c = surface.triangles[t];
    if (std::ranges::none_of(c, [&](std::uint32_t v) { return has_column(columns, v); })) continue;
    if (surface.patches[surface.patch[t]].regions[0] == 0) std::swap(c[1], c[2]);  // the fluid is behind
    mesh.stacks.triangle.push_back(t);
    for (std::size_t k = 0; k < shares.size(); ++k)
      mesh.stacks.prisms.push_back({above(c[0], k), above(c[1], k), above(c[2], k), above(c[0], k + 1),
                                    above(c[1], k + 1), above(c[2], k + 1)});
  }
}

double area_of(const ConformingSurface& surface, std::size_t t) {
  const auto at = [&](std::size_t k) -> const Vector<3>& {
    return surface.vertices[surface.triangles[t][k]];
  };
  return 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
}

PrismReport report_of(const ConformingSurface& surface, const std::vector<Vector<3>>& columns,
                      const VolumeMesh& mesh) {
  PrismReport report;
  double area = 0, covered = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (surface.patches[surface.patch[t]].kind != SurfacePatch::Kind::sphere) continue;
    area += area_of(surface, t);
    if (std::ranges::all_of(surface.triangles[t], [&](std::uint32_t v) { return has_column(columns, v); }))
      covered += area_of(surface, t);
  }
  report.covered = area > 0 ? covered / area : 0;
  std::size_t count = 0;
  for (const Vector<3>& column : columns) {
    const double height = column.norm();
    if (height == 0) continue;
    report.least_height = count == 0 ? height : std::min(report.least_height, height);
    report.mean_height += height;
    ++count;
  }
  if (count > 0) report.mean_height /= static_cast<double>(count);
  for (const PrismCorners& prism : mesh.stacks.prisms) {
    report.prisms += distinct_corners(prism).size() == prism.size();
    report.least_scaled_jacobian = std::min(report.least_scaled_jacobian, scaled_jacobian(mesh, prism));
  }
  report.ends = mesh.stacks.prisms.size() - report.prisms;
  return report;
}

}  // namespace

double scaled_jacobian(const VolumeMesh& mesh, const PrismCorners& prism) {
  constexpr double of_upright = 0.86602540378443865;  // the sine of 60 degrees
  double least = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (prism[k] == prism[k + 3]) continue;
    const Vector<3> up = mesh.vertices[prism[k + 3]] - mesh.vertices[prism[k]];
    for (const std::size_t level : {0, 3}) {
      const Vector<3>& at = mesh.vertices[prism[k + level]];
      const Vector<3> u = mesh.vertices[prism[(k + 1) % 3 + level]] - at;
      const Vector<3> v = mesh.vertices[prism[(k + 2) % 3 + level]] - at;
      least = std::min(least, u.cross(v).dot(up) / (u.norm() * v.norm() * up.norm()) / of_upright);
    }
  }
  return least;
}

VolumeMesh fill_with_prisms(const ConformingSurface& surface, const BoundaryLayerOptions& options,
                            const TetrahedraOptions& tetrahedra, FillReport& filled, PrismReport& report,
                            const Monitor& monitor) {
  const std::vector<Vector<3>> columns = prism_columns(surface, options);
  VolumeMesh mesh;
  {
    ConformingSurface raised = surface;
    for (std::size_t v = 0; v < columns.size(); ++v) raised.vertices[v] += columns[v];
    mesh = fill(raised, tetrahedra, filled, monitor);
  }
  add_stacks(surface, columns, options, mesh);
  report = report_of(surface, columns, mesh);
  if (!(report.least_scaled_jacobian > 0))
    throw Error(ErrorCode::bad_mesh, "a prism of the mesh is turned inside out: lower prisms help");
  require_filled(mesh, surface, filled);
  return mesh;
}

}  // namespace bernal
