#include "cad/make_triangles.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_map.hpp>
#include <boost/unordered/unordered_set.hpp>

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Polygon = std::vector<std::uint32_t>;

/// Numbers points by value, in the order in which they are first asked for.
class Welder {
 public:
  explicit Welder(std::vector<Vector<3>>& points) : points_(points) {}

  std::uint32_t index_of(const Vector<3>& p) {
    const std::array<double, 3> key = {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // -0.0 + 0.0 is +0.0
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<std::uint32_t>(points_.size()));
    if (is_new) points_.emplace_back(key[0], key[1], key[2]);
    return entry->second;
  }

 private:
  std::vector<Vector<3>>& points_;
  boost::unordered_map<std::array<double, 3>, std::uint32_t> index_;
};

void drop_consecutive_equals(Polygon& polygon) {
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
}

/// All polygons as separate faces of one mesh, because CGAL triangulates the faces of a mesh.
class PolygonTriangulation {
 public:
  explicit PolygonTriangulation(const std::vector<Vector<3>>& points) : points_(points) {}

  void add(const Polygon& polygon) {
    std::vector<SurfaceMesh::Vertex_index> corners;
    for (const std::uint32_t v : polygon) {
      corners.push_back(faces_.add_vertex({points_[v][0], points_[v][1], points_[v][2]}));
      vertex_of_.push_back(v);
    }
    faces_.add_face(corners);
  }

  void append_to(std::vector<std::array<std::uint32_t, 3>>& triangles) {
    CGAL::Polygon_mesh_processing::triangulate_faces(faces_);
    for (const auto face : faces_.faces()) {
      Polygon corners;
      for (const auto v : CGAL::vertices_around_face(faces_.halfedge(face), faces_))
        corners.push_back(vertex_of_[v]);
      // A polygon that CGAL cannot project without folding is fanned; the self-intersections then tell.
      for (std::size_t k = 2; k < corners.size(); ++k)
        triangles.push_back({corners[0], corners[k - 1], corners[k]});
    }
  }

 private:
  const std::vector<Vector<3>>& points_;
  std::vector<std::uint32_t> vertex_of_;
  SurfaceMesh faces_;
};

std::array<std::uint32_t, 3> smallest_first(std::array<std::uint32_t, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

}  // namespace

Triangles make_triangles(const PolygonSoup& soup) {
  Triangles result;
  Welder welder(result.mesh.vertices);
  PolygonTriangulation larger(result.mesh.vertices);
  std::vector<bool> used(soup.points.size(), false);

  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Polygon& polygon : soup.polygons) {
    Polygon corners;
    for (const std::uint32_t i : polygon) {
      corners.push_back(welder.index_of(soup.points[i]));
      used[i] = true;
    }
    drop_consecutive_equals(corners);
    if (corners.size() < 3) {
      ++result.collapsed;
    } else if (corners.size() == 3) {
      triangles.push_back({corners[0], corners[1], corners[2]});
    } else {
      ++result.triangulated;
      larger.add(corners);
    }
  }
  larger.append_to(triangles);
  result.welded =
      static_cast<std::uint64_t>(std::count(used.begin(), used.end(), true)) - result.mesh.vertices.size();

  boost::unordered_set<std::array<std::uint32_t, 3>> seen;
  seen.reserve(triangles.size());
  for (const auto& t : triangles) {
    if (seen.insert(smallest_first(t)).second) {
      result.mesh.triangles.push_back(t);
    } else {
      ++result.repeated;
    }
  }
  return result;
}

}  // namespace bernal::cad
