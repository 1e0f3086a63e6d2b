// Surfaces that go on beyond the ends of periods.
#include "mesh_files/periodic_copies.hpp"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include "geometry/edges.hpp"
#include "support/surface_oracle.hpp"

namespace bernal {
namespace periodic_copies_test {

Solids solids_of_bed(const Domain& box, ContactTreatment contact) {
  return conforming_surface_test::solids_in(conforming_surface_test::scattered(box, 0.5, 2000, 7), box,
                                            contact);
}

VolumeMesh triangles_of(const Solids& solids) {
  ConformingSurface surface = conforming_surface(solids, {});
  VolumeMesh mesh;
  mesh.vertices = std::move(surface.vertices);
  mesh.triangles = std::move(surface.triangles);
  mesh.patch = std::move(surface.patch);
  mesh.patches = std::move(surface.patches);
  mesh.periodic = std::move(surface.periodic);
  return mesh;
}

TEST(PeriodicCopies, SurfacesEndOutsideOfTheMarginOnly) {
  for (const std::vector<bool>& walls : {std::vector<bool>{}, {false, false, true}}) {
    const Domain box = periodic_box(Vector<3>(3, 3.5, 4), walls);
    const Solids solids = solids_of_bed(box, ContactTreatment::gap);
    const Boundary<3> boundary = boundary_of<3>(solids.domain);  // whose periods begin elsewhere
    const VolumeMesh mesh = triangles_of(solids);
    constexpr double margin = 0.4;
    const OpenSurface surface = with_periodic_copies(mesh, boundary, margin);
    EXPECT_GT(surface.triangles.size(), mesh.triangles.size());
    const std::vector<EdgeUse> open = open_edges(surface.triangles);
    EXPECT_FALSE(open.empty());
    for (const EdgeUse& edge : open)
      for (const std::uint32_t v : {edge.low, edge.high}) {
        double beyond = -1;
        for (int k = 0; k < 3; ++k)
          if (boundary.repeats(k)) {
            const double at = surface.vertices[v][k] - boundary.origin[k];
            beyond = std::max({beyond, -at, at - boundary.edges[k]});
          }
        EXPECT_GE(beyond, margin);
      }
    // No vertex twice, and each triangle is its own, moved by whole periods.
    std::map<std::array<double, 3>, int> places;
    for (const Vector<3>& v : surface.vertices) EXPECT_EQ(++places[(std::array{v[0], v[1], v[2]})], 1);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const Vector<3> moved =
            surface.vertices[surface.triangles[t][c]] - mesh.vertices[mesh.triangles[surface.triangle[t]][c]];
        EXPECT_LT((boundary.minimum_image(moved)).norm(), 1e-12);
      }
  }
}

TEST(PeriodicCopies, WithoutPeriodsNothingIsAdded) {
  const Domain box = Box{Vector<3>::Zero(), Vector<3>(3, 3.5, 4)};
  const VolumeMesh mesh = triangles_of(solids_of_bed(box, ContactTreatment::bridge));
  const OpenSurface surface = with_periodic_copies(mesh, boundary_of<3>(box), 0.4);
  EXPECT_EQ(surface.triangles, mesh.triangles);
  EXPECT_TRUE(open_edges(surface.triangles).empty());
}

}  // namespace periodic_copies_test
}  // namespace bernal
