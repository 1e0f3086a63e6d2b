#include "cad/repair/close_seams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "cad/diagnose/counted.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/point_cubes.hpp"
#include "geometry/changes.hpp"
#include "geometry/point_numbers.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {
namespace {

PointCubes in_cubes(const Mesh& mesh, const std::vector<std::uint32_t>& corners, double edge) {
  PointCubes cubes(edge);
  for (const std::uint32_t v : corners) cubes.add(v, mesh.vertices[v]);
  return cubes;
}

std::vector<std::uint32_t> ends_of(const std::vector<EdgeUse>& edges) {
  std::vector<std::uint32_t> corners;
  for (const EdgeUse& edge : edges) corners.insert(corners.end(), {edge.low, edge.high});
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Merges corners of open edges nearer than the tolerance into the one with the smallest number.
void weld(Mesh& mesh, double tolerance, Seams& seams) {
  const std::vector<std::uint32_t> corners = ends_of(open_edges(mesh.triangles));
  if (corners.empty()) return;
  const PointCubes cubes = in_cubes(mesh, corners, 2 * tolerance);
  std::vector<std::uint32_t> same(mesh.vertices.size());
  for (std::uint32_t v = 0; v < same.size(); ++v) same[v] = v;
  for (const std::uint32_t v : corners) {
    if (same[v] != v) continue;
    const Vector<3>& p = mesh.vertices[v];
    const Vector<3> reach = Vector<3>::Constant(tolerance);
    cubes.each_in(p - reach, p + reach, [&](std::uint32_t other) {
      const double d = (mesh.vertices[other] - p).norm();
      if (other <= v || same[other] != other || d > tolerance) return;
      same[other] = v;
      ++seams.welded;
      seams.widest = std::max(seams.widest, d);
    });
  }
  renumber(mesh.triangles, [&](std::uint32_t v) { return same[v]; });
  std::erase_if(mesh.triangles,
                [](const FaceCorners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

/// The corners that lie within an open edge, in their order along it.
std::vector<std::uint32_t> corners_within(const Mesh& mesh, const PointCubes& cubes, std::uint32_t a,
                                          std::uint32_t b, double tolerance) {
  const Vector<3>&p = mesh.vertices[a], &q = mesh.vertices[b];
  const Vector<3> along = q - p, reach = Vector<3>::Constant(tolerance);
  std::vector<std::pair<double, std::uint32_t>> found;
  cubes.each_in(p.cwiseMin(q) - reach, p.cwiseMax(q) + reach, [&](std::uint32_t v) {
    if (v == a || v == b) return;
    const double at = along.dot(mesh.vertices[v] - p) / along.squaredNorm();
    if (at > 0 && at < 1 && (p + at * along - mesh.vertices[v]).norm() <= tolerance)
      found.emplace_back(at, v);
  });
  std::ranges::sort(found);
  std::vector<std::uint32_t> corners;
  for (const auto& entry : found) corners.push_back(entry.second);
  return corners;
}

/// Splits open edges at the corners within them, one edge of a triangle at a time. Returns whether there were
/// any.
bool split_edges(Mesh& mesh, double tolerance, Seams& seams) {
  const std::vector<EdgeUse> edges = open_edges(mesh.triangles);
  if (edges.empty()) return false;
  const std::vector<std::uint32_t> corners = ends_of(edges);
  double length = 0;
  for (const EdgeUse& edge : edges) length += (mesh.vertices[edge.low] - mesh.vertices[edge.high]).norm();
  const PointCubes cubes =
      in_cubes(mesh, corners, std::max(2 * tolerance, length / static_cast<double>(edges.size())));
  std::uint32_t last = no_index;
  bool any = false;
  for (const EdgeUse& edge : edges) {
    const auto [t, k] = std::pair(edge.triangle, edge.side);
    if (t == last) continue;
    const FaceCorners old = mesh.triangles[t];
    const std::uint32_t a = old[k], b = old[(k + 1) % 3], apex = old[(k + 2) % 3];
    std::vector<std::uint32_t> within = corners_within(mesh, cubes, a, b, tolerance);
    std::erase(within, apex);
    if (within.empty()) continue;
    last = t;
    any = true;
    ++seams.split;
    mesh.triangles[t] = {a, within.front(), apex};
    within.push_back(b);
    for (std::size_t i = 0; i + 1 < within.size(); ++i)
      mesh.triangles.push_back({within[i], within[i + 1], apex});
  }
  return any;
}

/// Drops one of two faces with the same corners and opposite orientation, if every one of their edges has a
/// single other face, so that the surface needs one there.
void drop_doubled(Mesh& mesh, Seams& seams) {
  const MeshEdges edges(mesh.triangles);
  std::vector<std::pair<FaceCorners, std::uint32_t>> faces;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    faces.emplace_back(mesh.triangles[t], t);
    std::ranges::sort(faces.back().first);
  }
  std::ranges::sort(faces);
  std::vector<bool> kept(mesh.triangles.size(), true);
  for (auto first = faces.begin(); first != faces.end();) {
    const FaceCorners& t = first->first;
    const auto last = std::find_if(first, faces.end(), [&](const auto& face) { return face.first != t; });
    if (last - first == 2 && edges.triangles_at(t[0], t[1]) == 3 && edges.triangles_at(t[1], t[2]) == 3 &&
        edges.triangles_at(t[0], t[2]) == 3) {
      kept[first[1].second] = false;
      ++seams.doubled;
    }
    first = last;
  }
  if (seams.doubled == 0) return;
  keep_only(mesh, kept);
}

/// Half a unit in the last decimal that some coordinate needs, at least of six digits, at the size of the
/// largest.
double decimal_rounding(const Mesh& mesh, double largest) {
  constexpr std::size_t most = 3000;
  constexpr int fewest = 6;
  const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / most);
  int digits = fewest;
  for (std::size_t v = 0; v < mesh.vertices.size(); v += step)
    for (int k = 0; k < 3; ++k) {
      const double c = std::abs(mesh.vertices[v][k]);
      while (digits < 17 && std::strtod(fmt::format("{:.{}e}", c, digits - 1).c_str(), nullptr) != c)
        ++digits;
    }
  return 0.5 * std::pow(10.0, std::floor(std::log10(largest)) + 1 - digits);
}

}  // namespace

std::vector<std::string> Seams::in_words() const {
  std::vector<std::string> words;
  const auto say = [&](std::uint64_t n, const char* verb, const char* one, const char* many) {
    if (n > 0) words.push_back(fmt::format("{} {}", verb, counted(n, one, many)));
  };
  say(collinear, "dropped", "face whose corners lie on a line", "faces whose corners lie on a line");
  say(doubled, "dropped", "face that lies on another one", "faces that lie on another one");
  if (welded > 0)
    words.push_back(fmt::format("welded {} up to {:.2g} away", counted(welded, "corner", "corners"), widest));
  say(split, "split", "edge at a neighbour's corner", "edges at neighbours' corners");
  return words;
}

double rounding_of_coordinates(const Mesh& mesh) {
  double largest = 0;
  bool single = true;
  for (const Vector<3>& v : mesh.vertices) {
    largest = std::max(largest, v.cwiseAbs().maxCoeff());
    for (int k = 0; k < 3; ++k) single = single && static_cast<double>(static_cast<float>(v[k])) == v[k];
  }
  if (largest == 0) return std::numeric_limits<double>::min();
  // Two copies of a corner may differ by a few operations in that precision, such as a rotation and a shift.
  constexpr double operations = 8;
  const double in_double = std::numeric_limits<double>::epsilon() * largest;
  const double rounding =
      single ? std::numeric_limits<float>::epsilon() * largest : decimal_rounding(mesh, largest);
  return operations * std::max(rounding, in_double);
}

Seams close_seams(Mesh& mesh, double tolerance) {
  Seams seams;
  const std::size_t before = mesh.triangles.size();
  if (count_degenerate(mesh) > 0) {
    std::erase_if(mesh.triangles, [&](const FaceCorners& t) { return is_degenerate(mesh, t); });
    seams.collinear = before - mesh.triangles.size();
  }
  drop_doubled(mesh, seams);
  weld(mesh, tolerance, seams);
  // Each round at least halves the rest of an edge; more rounds mean that it does not converge.
  constexpr int most_rounds = 64;
  for (int round = 0; round < most_rounds && split_edges(mesh, tolerance, seams); ++round) {
  }
  if (seams.any()) drop_unused_vertices(mesh);
  return seams;
}

double closing_tolerance(const Mesh& mesh, double from, double widest) {
  for (double tolerance = from; tolerance <= widest; tolerance *= 2) {
    Mesh tried = mesh;
    close_seams(tried, tolerance);
    const MeshTopology topology = topology_of(tried);
    if (!tried.triangles.empty() && topology.closed()) return tolerance;
  }
  return 0;
}

}  // namespace bernal::cad
