#include "cad/diagnose/mesh_distance.hpp"

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_set.hpp>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "cad/triangle_tree.hpp"
#include "core/parallel.hpp"
#include "kernels/closest_point.hpp"

namespace bernal::cad {
namespace {

using Place3 = std::array<Vector<3>, 3>;
using PlaceKey = std::array<std::array<double, 3>, 3>;

constexpr double unbounded = std::numeric_limits<double>::infinity();

Place3 places_of(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// A key of a triangle, independent of its rotation.
PlaceKey sorted_places(const Place3& corners) {
  PlaceKey key;
  for (std::size_t k = 0; k < 3; ++k)
    key[k] = {corners[k][0] + 0.0, corners[k][1] + 0.0, corners[k][2] + 0.0};
  std::sort(key.begin(), key.end());
  return key;
}

struct Piece {
  Place3 corners;
  double farthest = 0;  ///< upper bound for its points
  bool operator<(const Piece& other) const { return farthest < other.farthest; }
};

/// The smallest enclosing ball of the triangle has its centre in the middle of the longest edge unless all
/// angles are acute; then the centroid is nearly as good.
Vector<3> middle_of(const Place3& c) {
  std::array<double, 3> squared;
  for (std::size_t k = 0; k < 3; ++k) squared[k] = (c[(k + 1) % 3] - c[k]).squaredNorm();
  const auto longest =
      static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
  const double others = squared[0] + squared[1] + squared[2] - squared[longest];
  if (squared[longest] >= others) return 0.5 * (c[longest] + c[(longest + 1) % 3]);
  return (c[0] + c[1] + c[2]) / 3;
}

class Measure {
 public:
  /// Distances have errors up to `rounding`.
  Measure(const Mesh& reference, double rounding) : tree_(reference), rounding_(rounding) {}

  /// Bounds of a part, and the position of its lower bound.
  Deviation look(const Place3& corners) const {
    const Vector<3> center = middle_of(corners);
    Deviation found;
    found.place = center;
    found.largest = tree_.distance(center, unbounded);
    double radius = 0;
    for (const Vector<3>& corner : corners) radius = std::max(radius, (corner - center).norm());
    found.at_most = found.largest + radius;

    std::vector<NearFacet> near;
    tree_.within(center, found.largest * (1 + 1e-9) + rounding_, near);
    for (std::size_t i = 0; i < std::min<std::size_t>(near.size(), 8); ++i) {
      const PreparedTriangle face(near[i].facet.a, near[i].facet.b, near[i].facet.c);
      double most = 0;
      for (const Vector<3>& corner : corners) most = std::max(most, face.offset(corner).norm());
      found.at_most = std::min(found.at_most, most);
    }
    for (const Vector<3>& corner : corners) {
      if (found.at_most <= found.largest) break;
      const double d = tree_.distance(corner, unbounded);
      if (d > found.largest) found.largest = d, found.place = corner;
    }
    return found;
  }

  /// Cuts a part that lies on a face of the reference and its neighbours along the edge beyond which it
  /// extends farthest; empty otherwise.
  std::vector<Place3> cut_by_face(const Place3& corners) const {
    std::vector<NearFacet> near;
    tree_.within(middle_of(corners), rounding_, near);
    for (const NearFacet& face : near) {
      const Place3 edges{face.facet.a, face.facet.b, face.facet.c};
      const Vector<3> normal = (edges[1] - edges[0]).cross(edges[2] - edges[0]).normalized();
      const auto height = [&](const Vector<3>& p) { return std::abs(normal.dot(p - edges[0])); };
      if (!std::ranges::all_of(corners, [&](const Vector<3>& p) { return height(p) <= rounding_; })) continue;
      std::array<double, 3> inside{}, least{};
      double farthest = -rounding_;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector<3> inward = normal.cross(edges[(k + 1) % 3] - edges[k]).normalized();
        for (std::size_t i = 0; i < 3; ++i) inside[i] = inward.dot(corners[i] - edges[k]);
        const auto [low, high] = std::ranges::minmax(inside);
        if (low >= farthest || high <= rounding_) continue;
        farthest = low;
        least = inside;
      }
      if (farthest < -rounding_) return cut(corners, least);
    }
    return {};
  }

 private:
  /// The parts where a linear function, given at the corners, is positive and negative.
  static std::vector<Place3> cut(const Place3& corners, const std::array<double, 3>& values) {
    std::vector<Place3> parts;
    for (const double sign : {1.0, -1.0}) {
      std::vector<Vector<3>> polygon;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (sign * values[i] >= 0) polygon.push_back(corners[i]);
        if (values[i] * values[next] < 0)
          polygon.emplace_back(corners[i] +
                               values[i] / (values[i] - values[next]) * (corners[next] - corners[i]));
      }
      for (std::size_t i = 2; i < polygon.size(); ++i)
        parts.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
    return parts;
  }

  TriangleTree tree_;
  double rounding_;
};

std::vector<Place3> in_two(const Place3& c) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if ((c[(k + 1) % 3] - c[k]).squaredNorm() > (c[(longest + 1) % 3] - c[longest]).squaredNorm())
      longest = k;
  const Vector<3>&a = c[longest], &b = c[(longest + 1) % 3], &apex = c[(longest + 2) % 3];
  const Vector<3> middle = 0.5 * (a + b);
  return {{{a, middle, apex}, {middle, b, apex}}};
}

}  // namespace

Deviation farthest(const Mesh& surface, const Mesh& reference, Closeness closeness, const Monitor& monitor,
                   std::uint64_t evaluations) {
  if (surface.triangles.empty() || reference.triangles.empty())
    throw Error(ErrorCode::bad_argument, "the distance between surfaces needs faces on both");
  boost::unordered_set<PlaceKey> known;
  known.reserve(reference.triangles.size());
  for (const auto& t : reference.triangles) known.insert(sorted_places(places_of(reference, t)));

  std::vector<Piece> parts;
  double extent = 0;
  for (const auto& t : surface.triangles) {
    const Place3 corners = places_of(surface, t);
    for (const Vector<3>& p : corners) extent = std::max(extent, p.cwiseAbs().maxCoeff());
    if (known.count(sorted_places(corners)) == 0) parts.push_back({corners});
  }
  for (const auto& t : reference.triangles)
    for (const Vector<3>& p : places_of(reference, t)) extent = std::max(extent, p.cwiseAbs().maxCoeff());
  // A distance in the tree has an error of a few roundoffs of the coordinates, the middle of an edge one.
  const double rounding = 64 * tolerance::roundoff * extent;

  Deviation result;
  result.place = surface.vertices[surface.triangles.front()[0]];
  if (parts.empty()) return result;
  const Measure measure(reference, rounding);
  const auto take = [&](const Deviation& found) {
    if (found.largest > result.largest) result.largest = found.largest, result.place = found.place;
  };

  std::vector<Deviation> found(parts.size(), {0, unbounded});
  constexpr std::size_t batch = 16'384;
  for (std::size_t first = 0; first < parts.size() && !monitor.stop(); first += batch)
    parallel_ranges(std::min(batch, parts.size() - first), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) found[i] = measure.look(parts[i].corners);
    });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    take(found[i]);
    parts[i].farthest = found[i].at_most;
  }

  std::priority_queue<Piece, std::vector<Piece>, std::less<>> queue(std::less<>(), std::move(parts));
  for (std::uint64_t looks = 0; looks < evaluations && !monitor.stop();) {
    const Piece worst = queue.top();
    const double apart = std::max({closeness.absolute, closeness.share * result.largest, rounding});
    if (worst.farthest <= result.largest + apart || worst.farthest == unbounded) break;
    queue.pop();
    std::vector<Place3> smaller = measure.cut_by_face(worst.corners);
    if (smaller.empty()) smaller = in_two(worst.corners);
    looks += smaller.size();
    for (const Place3& part : smaller) {
      const Deviation bounds = measure.look(part);
      take(bounds);
      queue.push({part, std::min(bounds.at_most, worst.farthest)});
    }
  }
  result.at_most = std::max(result.largest, queue.top().farthest) + rounding;
  return result;
}

}  // namespace bernal::cad
