#include "surfaces/icosphere.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace bernal {
namespace {

using Corners = std::array<std::uint32_t, 3>;

/// The vertices (0, ±1, ±g), (±1, ±g, 0) and (±g, 0, ±1) with the golden ratio g.
Icosphere icosahedron() {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  Icosphere made;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g})
      for (int k = 0; k < 3; ++k) {
        Vector<3> v = Vector<3>::Zero();
        v[(k + 1) % 3] = a;
        v[(k + 2) % 3] = b;
        made.vertices.push_back(v);
      }
  // Neighbours are 2 apart, all others more than 3.
  const auto near = [&](std::uint32_t i, std::uint32_t j) {
    return (made.vertices[i] - made.vertices[j]).squaredNorm() < 5;
  };
  for (std::uint32_t i = 0; i < 12; ++i)
    for (std::uint32_t j = i + 1; j < 12; ++j)
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!near(i, j) || !near(j, k) || !near(k, i)) continue;
        const auto& v = made.vertices;
        const bool outward = v[i].dot(v[j].cross(v[k])) > 0;
        made.triangles.push_back(outward ? Corners{i, j, k} : Corners{i, k, j});
      }
  return made;
}

/// Positions in the grid of a divided face, identified by the icosahedron's corners that they are between, so
/// that faces find the vertices of shared edges.
using Place = std::array<std::pair<std::uint32_t, int>, 3>;

Icosphere divided(int n) {
  const Icosphere base = icosahedron();
  Icosphere made;
  std::map<Place, std::uint32_t> known;
  for (const Corners& face : base.triangles) {
    const auto vertex = [&](int i, int j) {
      const std::array<int, 3> share = {n - i - j, i, j};
      Place place;
      for (std::size_t k = 0; k < 3; ++k) place[k] = {share[k] == 0 ? std::uint32_t{12} : face[k], share[k]};
      std::ranges::sort(place);
      const auto [at, is_new] = known.try_emplace(place, static_cast<std::uint32_t>(made.vertices.size()));
      if (is_new) {
        Vector<3> sum = Vector<3>::Zero();  // in the order of the place, so the same for all faces
        for (const auto& [corner, times] : place)
          if (times > 0) sum += times * base.vertices[corner];
        made.vertices.push_back(sum.normalized());
      }
      return at->second;
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        made.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j + 1 < n)
          made.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  made.inradius = 1;
  for (const auto& [a, b, c] : made.triangles) {
    const auto& v = made.vertices;
    made.inradius = std::min(made.inradius, distance_from_origin(v[a], v[b], v[c]));
    made.volume += v[a].dot(v[b].cross(v[c])) / 6;
  }
  return made;
}

}  // namespace

double distance_from_origin(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
  const Vector<3> normal = (b - a).cross(c - a);
  const auto beside = [&](const Vector<3>& p, const Vector<3>& q) { return normal.dot(p.cross(q)) < 0; };
  if (normal.squaredNorm() > 0 && !beside(a, b) && !beside(b, c) && !beside(c, a))
    return std::abs(normal.dot(a)) / normal.norm();
  const auto of_edge = [](const Vector<3>& p, const Vector<3>& q) {
    const Vector<3> edge = q - p;
    const double squared = edge.squaredNorm();
    const double t = squared > 0 ? std::clamp(-p.dot(edge) / squared, 0.0, 1.0) : 0.0;
    return (p + t * edge).norm();
  };
  return std::min({of_edge(a, b), of_edge(b, c), of_edge(c, a)});
}

const Icosphere& icosphere(int frequency) {
  static std::mutex mutex;
  static std::map<int, std::unique_ptr<const Icosphere>> made;
  const std::lock_guard lock(mutex);
  std::unique_ptr<const Icosphere>& entry = made[frequency];
  if (!entry) entry = std::make_unique<const Icosphere>(divided(frequency));
  return *entry;
}

int frequency_for(double deflection) {
  // The largest triangles, in the middle of the faces, shrink with the square of the frequency.
  int frequency = std::max(1, static_cast<int>(0.35 / std::sqrt(deflection)));
  while (frequency < most_frequent && 1 - icosphere(frequency).inradius > deflection) ++frequency;
  return std::min(frequency, most_frequent);
}

}  // namespace bernal
