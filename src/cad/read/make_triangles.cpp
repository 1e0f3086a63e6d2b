#include "cad/read/make_triangles.hpp"

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_set.hpp>
#include <utility>

#include "cad/read/triangulate.hpp"
#include "geometry/point_numbers.hpp"

namespace bernal::cad {
namespace {

using Polygon = std::vector<std::uint32_t>;

void drop_consecutive_equals(Polygon& polygon) {
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
}

FaceCorners smallest_first(FaceCorners t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// If every triangle occurs in both orientations, as exported by programs that draw both sides of a face,
/// keeps the first of each two. `there` holds all of them, smallest corner first. Returns the number dropped.
/// Cost: usually O(1), because the first triangle without a back decides.
std::uint64_t drop_back_sides(std::vector<FaceCorners>& triangles, boost::unordered_set<FaceCorners>& there) {
  const auto turned = [](const auto& t) { return smallest_first({t[0], t[2], t[1]}); };
  if (!std::ranges::all_of(triangles, [&](const auto& t) { return there.count(turned(t)) > 0; })) return 0;
  return std::erase_if(triangles, [&](const auto& t) {
    if (there.count(smallest_first(t)) == 0) return true;
    there.erase(turned(t));
    return false;
  });
}

}  // namespace

Triangles make_triangles(const PolygonSoup& soup) {
  Triangles result;
  PointNumbers<Vector<3>> numbers;
  std::vector<Polygon> larger;
  std::vector<bool> used(soup.points.size(), false);

  std::vector<FaceCorners> triangles;
  for (const Polygon& polygon : soup.polygons) {
    Polygon corners;
    for (const std::uint32_t i : polygon) {
      corners.push_back(numbers.of((soup.points[i].array() + 0.0).matrix()));  // -0 is 0
      used[i] = true;
    }
    drop_consecutive_equals(corners);
    if (corners.size() < 3) {
      ++result.collapsed;
    } else if (corners.size() == 3) {
      triangles.push_back({corners[0], corners[1], corners[2]});
    } else {
      ++result.triangulated;
      larger.push_back(std::move(corners));
    }
  }
  result.mesh.vertices = std::move(numbers.points);
  // One triangle of each polygon, then the others: the last bits of packings depend on the order.
  std::vector<FaceCorners> others;
  for (const Polygon& polygon : larger) {
    const auto pieces = triangulate(result.mesh.vertices, polygon);
    triangles.push_back(pieces.front());
    others.insert(others.end(), pieces.begin() + 1, pieces.end());
  }
  triangles.insert(triangles.end(), others.begin(), others.end());
  result.welded =
      static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true)) - result.mesh.vertices.size();

  boost::unordered_set<FaceCorners> seen;
  seen.reserve(triangles.size());
  for (const auto& t : triangles) {
    if (seen.insert(smallest_first(t)).second) {
      result.mesh.triangles.push_back(t);
    } else {
      ++result.repeated;
    }
  }
  result.back_sides = drop_back_sides(result.mesh.triangles, seen);
  return result;
}

}  // namespace bernal::cad
