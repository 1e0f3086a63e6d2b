#include "cad/self_intersections.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <vector>

#include "core/parallel.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<std::uint32_t, 3>;

class TrianglePairs {
 public:
  explicit TrianglePairs(const Mesh& mesh) : mesh_(mesh) {}

  Point point(std::uint32_t v) const {
    const Vector<3>& p = mesh_.vertices[v];
    return {p[0], p[1], p[2]};
  }
  Kernel::Triangle_3 triangle(const Corners& t) const { return {point(t[0]), point(t[1]), point(t[2])}; }

  bool degenerate(const Corners& t) const { return CGAL::collinear(point(t[0]), point(t[1]), point(t[2])); }

  /// Whether s and t, not degenerate, share more than their common vertices and edges.
  bool intersect(Corners s, Corners t) const {
    const auto shared =
        static_cast<int>(std::stable_partition(s.begin(), s.end(), contained_in(t)) - s.begin());
    std::stable_partition(t.begin(), t.end(), contained_in(s));
    switch (shared) {
      case 0:
        return CGAL::do_intersect(triangle(s), triangle(t));
      case 1:
        return CGAL::do_intersect(triangle(s), Kernel::Segment_3(point(t[1]), point(t[2]))) ||
               CGAL::do_intersect(triangle(t), Kernel::Segment_3(point(s[1]), point(s[2])));
      case 2: {  // only when folded onto each other
        const Point a = point(s[0]), b = point(s[1]), c = point(s[2]), d = point(t[2]);
        return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
      }
      default:
        return true;
    }
  }

 private:
  struct contained_in {
    explicit contained_in(const Corners& c) : corners(c) {}
    bool operator()(std::uint32_t v) const {
      return std::find(corners.begin(), corners.end(), v) != corners.end();
    }
    const Corners corners;
  };

  const Mesh& mesh_;
};

}  // namespace

bool is_degenerate(const Mesh& mesh, const Corners& triangle) {
  return TrianglePairs(mesh).degenerate(triangle);
}

std::uint64_t count_degenerate(const Mesh& mesh) {
  const TrianglePairs pairs(mesh);
  return static_cast<std::uint64_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                                                  [&](const Corners& t) { return pairs.degenerate(t); }));
}

namespace {

/// Calls found(s, t) for each of the pairs, with their triangles, until it says that they are enough.
template <class Found>
void for_each_intersecting_pair(const Mesh& mesh, const Found& found) {
  using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Corners*>;
  struct Enough {};
  const TrianglePairs pairs(mesh);
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const Corners& t : mesh.triangles)
    if (!pairs.degenerate(t)) boxes.emplace_back(pairs.triangle(t).bbox(), &t);

  try {
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& s, const Box& t) {
      throw_if_interrupted();
      if (pairs.intersect(*s.handle(), *t.handle()) && !found(s.handle(), t.handle())) throw Enough();
    });
  } catch (const Enough&) {
  }
}

}  // namespace

std::uint64_t most_self_intersections(const Mesh& mesh) { return 50'000 + 2 * mesh.triangles.size(); }

bool intersects_itself(const Mesh& mesh) {
  bool found = false;
  for_each_intersecting_pair(mesh, [&](const Corners*, const Corners*) {
    found = true;
    return false;
  });
  return found;
}

std::vector<std::array<std::uint32_t, 2>> self_intersecting_pairs(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  const std::uint64_t most = most_self_intersections(mesh);
  const auto number = [&](const Corners* t) { return static_cast<std::uint32_t>(t - mesh.triangles.data()); };
  for_each_intersecting_pair(mesh, [&](const Corners* s, const Corners* t) {
    const auto [low, high] = std::minmax({number(s), number(t)});
    pairs.push_back({low, high});
    return pairs.size() < most;
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::uint64_t count_self_intersections(const Mesh& mesh) { return self_intersecting_pairs(mesh).size(); }

}  // namespace bernal::cad
