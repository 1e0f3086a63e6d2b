#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "bernal/run/run.hpp"
#include "meshes/conforming_surface.hpp"
#include "solids/solids.hpp"
#include "support/plans.hpp"

// The surface of ten thousand bridged beads, by predicates of CGAL, which its maker does not use: every edge
// is in two triangles, and no two triangles meet but in what they share.
namespace bernal {
namespace mesh_surface_validation_test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::size_t edges_not_of_two_triangles(const ConformingSurface& surface) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const FaceCorners& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::ranges::sort(edges);
  std::size_t found = 0;
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
    while (next < edges.size() && edges[next] == edges[i]) ++next;
    found += next - i != 2;
  }
  return found;
}

class Meeting {
 public:
  explicit Meeting(const ConformingSurface& surface) : surface_(surface) {}

  /// Whether two triangles share more than the corners that both name.
  bool operator()(const FaceCorners& a, const FaceCorners& b) const {
    std::vector<std::size_t> in_a, in_b;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (a[i] == b[j]) {
          in_a.push_back(i);
          in_b.push_back(j);
        }
    if (in_a.size() == 3) return true;
    if (in_a.empty()) return CGAL::do_intersect(triangle(a), triangle(b));
    if (in_a.size() == 1)
      return CGAL::do_intersect(opposite(a, in_a[0]), triangle(b)) ||
             CGAL::do_intersect(opposite(b, in_b[0]), triangle(a));
    const Kernel::Point_3 p = at(a[in_a[0]]), q = at(a[in_a[1]]), one = at(a[3 - in_a[0] - in_a[1]]),
                          other = at(b[3 - in_b[0] - in_b[1]]);
    return CGAL::coplanar(p, q, one, other) && CGAL::coplanar_orientation(p, q, one, other) == CGAL::POSITIVE;
  }
  Kernel::Triangle_3 triangle(const FaceCorners& t) const { return {at(t[0]), at(t[1]), at(t[2])}; }

 private:
  Kernel::Point_3 at(std::uint32_t v) const {
    const Vector<3>& p = surface_.vertices[v];
    return {p[0], p[1], p[2]};
  }
  Kernel::Segment_3 opposite(const FaceCorners& t, std::size_t corner) const {
    return {at(t[(corner + 1) % 3]), at(t[(corner + 2) % 3])};
  }

  const ConformingSurface& surface_;
};

TEST(MeshSurface, OfTenThousandBridgedBeadsIsClosedAndMeetsItselfNowhere) {
  const Packing packing = run(
      testing::plan_of("unit = \"mm\"\nseed = 1\n[container]\nkind = \"cylinder\"\nradius = 5\nheight = 113\n"
                       "[spheres]\ncount = 10000\ndiameter = 1\n"));
  ASSERT_EQ(packing.spheres.size(), 10000U);
  const Solids solids =
      solids_of(packing.spheres, packing.domain,
                {.contact = ContactTreatment::bridge, .gap = 0.01, .bridge_radius = 0.2}, {});
  const ConformingSurface surface = conforming_surface(solids, {.per_gap = 4});
  EXPECT_GT(surface.necks.size(), 10000U);
  EXPECT_EQ(edges_not_of_two_triangles(surface), 0U);
  using Bounds = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;
  const Meeting meet(surface);
  std::vector<Bounds> bounds;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    bounds.emplace_back(meet.triangle(surface.triangles[t]).bbox(), t);
  std::size_t near = 0, met = 0;
  CGAL::box_self_intersection_d(bounds.begin(), bounds.end(), [&](const Bounds& one, const Bounds& other) {
    ++near;
    met += meet(surface.triangles[one.info()], surface.triangles[other.info()]);
  });
  EXPECT_GT(near, 6 * surface.triangles.size());
  EXPECT_EQ(met, 0U);
}

}  // namespace mesh_surface_validation_test
}  // namespace bernal
