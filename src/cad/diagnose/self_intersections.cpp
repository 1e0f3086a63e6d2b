#include "cad/diagnose/self_intersections.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "cad/diagnose/separation.hpp"
#include "core/parallel.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

using ThreePoints = std::array<Vector<3>, 3>;

/// Whether a plane provably separates the triangle from a segment or another triangle: the triangle's own, or
/// one normal to it along an edge of either. The latter suffices for coplanar ones.
bool is_apart(const ThreePoints& triangle, std::span<const Vector<3>> other) {
  const Separation separation(triangle, other, triangle[0]);
  const Vector<3> normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const auto parted_along_edge = [&](const Vector<3>& p, const Vector<3>& q) {
    return separation.proven_along(normal.cross(q - p));
  };
  return separation.proven_along(normal) || parted_along_edge(triangle[0], triangle[1]) ||
         parted_along_edge(triangle[1], triangle[2]) || parted_along_edge(triangle[2], triangle[0]) ||
         parted_along_edge(other[0], other[1]) ||
         (other.size() == 3 &&
          (parted_along_edge(other[1], other[2]) || parted_along_edge(other[2], other[0])));
}

/// Whether c and d provably lie on different sides of the line through a and b, projected along an axis. With
/// u = 2^-53 a sign is proven beyond 4u times the sum of the two products (Shewchuk 1997, ccw).
bool are_on_both_sides(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c, const Vector<3>& d) {
  int axis = 0;
  (b - a).cross(c - a).cwiseAbs().maxCoeff(&axis);
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const auto side = [&](const Vector<3>& p) {
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    const double left = (a[x] - p[x]) * (b[y] - p[y]), right = (a[y] - p[y]) * (b[x] - p[x]);
    const double wrong = 4 * u * (std::abs(left) + std::abs(right)) + std::numeric_limits<double>::min();
    return left - right > wrong ? 1 : left - right < -wrong ? -1 : 0;
  };
  return side(c) * side(d) < 0;
}

/// Exact predicates on triangles; most pairs are separated in double precision first.
class TrianglePairs {
 public:
  explicit TrianglePairs(const Mesh& mesh) : mesh_(mesh) {}

  Kernel::Triangle_3 triangle(const FaceCorners& t) const { return triangle(points_of(t)); }
  bool degenerate(const FaceCorners& t) const {
    const auto [a, b, c] = points_of(t);
    return CGAL::collinear(exact(a), exact(b), exact(c));
  }

  /// Whether s and t, not degenerate, share more than their common vertices and edges.
  bool intersect(FaceCorners s, FaceCorners t) const {
    const int shared = move_shared_to_front(s, t);
    const ThreePoints p = points_of(s), q = points_of(t);
    switch (shared) {
      case 0:
        return !is_apart(p, q) && !is_apart(q, p) && CGAL::do_intersect(triangle(p), triangle(q));
      case 1:
        return meets_far_side(p, q) || meets_far_side(q, p);
      case 2:  // only when folded onto each other
        return !are_on_both_sides(p[0], p[1], p[2], q[2]) &&
               CGAL::coplanar(exact(p[0]), exact(p[1]), exact(p[2]), exact(q[2])) &&
               CGAL::coplanar_orientation(exact(p[0]), exact(p[1]), exact(p[2]), exact(q[2])) ==
                   CGAL::POSITIVE;
      default:
        return true;
    }
  }

 private:
  static Point exact(const Vector<3>& p) { return {p[0], p[1], p[2]}; }
  static Kernel::Triangle_3 triangle(const ThreePoints& p) { return {exact(p[0]), exact(p[1]), exact(p[2])}; }

  /// Whether the triangle meets the far side of the other one, opposite their common first corner.
  static bool meets_far_side(const ThreePoints& p, const ThreePoints& other) {
    return !is_apart(p, std::span(other).last<2>()) &&
           CGAL::do_intersect(triangle(p), Kernel::Segment_3(exact(other[1]), exact(other[2])));
  }

  /// In the same order in both; the rest is rotated. Returns the number of shared corners.
  static int move_shared_to_front(FaceCorners& s, FaceCorners& t) {
    int shared = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = shared; j < 3; ++j)
        if (s[i] == t[j]) {
          std::swap(s[i], s[shared]);
          std::swap(t[j], t[shared]);
          ++shared;
          break;
        }
    return shared;
  }

  ThreePoints points_of(const FaceCorners& t) const {
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }

  const Mesh& mesh_;
};

}  // namespace

bool is_degenerate(const Mesh& mesh, const FaceCorners& triangle) {
  return TrianglePairs(mesh).degenerate(triangle);
}

std::uint64_t count_degenerate(const Mesh& mesh) {
  const TrianglePairs pairs(mesh);
  return static_cast<std::uint64_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                                                  [&](const FaceCorners& t) { return pairs.degenerate(t); }));
}

namespace {

/// Calls found(s, t) for each pair, with its triangles, until it returns that they are enough.
template <class Found>
void for_each_intersecting_pair(const Mesh& mesh, const Found& found) {
  using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const FaceCorners*>;
  struct Enough {};
  const TrianglePairs pairs(mesh);
  std::vector<Box> boxes;
  boxes.reserve(mesh.triangles.size());
  for (const FaceCorners& t : mesh.triangles)
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
  for_each_intersecting_pair(mesh, [&](const FaceCorners*, const FaceCorners*) {
    found = true;
    return false;
  });
  return found;
}

std::vector<std::array<std::uint32_t, 2>> self_intersecting_pairs(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 2>> pairs;
  const std::uint64_t most = most_self_intersections(mesh);
  const auto number = [&](const FaceCorners* t) {
    return static_cast<std::uint32_t>(t - mesh.triangles.data());
  };
  for_each_intersecting_pair(mesh, [&](const FaceCorners* s, const FaceCorners* t) {
    const auto [low, high] = std::minmax({number(s), number(t)});
    pairs.push_back({low, high});
    return pairs.size() < most;
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::uint64_t count_self_intersections(const Mesh& mesh) { return self_intersecting_pairs(mesh).size(); }

}  // namespace bernal::cad
