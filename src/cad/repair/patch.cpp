#include "cad/repair/patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "cad/read/triangulate.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {
namespace {

/// With more corners the cubic search takes longer than half a second.
constexpr std::size_t most_searched = 400;

/// A rim within this share of its width of a plane is filled in that plane.
constexpr double flat_enough = 0.01;

/// The sides of faces without a neighbour. Faces are consistently oriented, so at each corner as many begin
/// as end.
class Rims {
 public:
  explicit Rims(const Mesh& mesh) : mesh_(mesh) {
    MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
      if (uses.size() == 2) return;
      for (const EdgeUse& use : uses) rims_.push_back({use.triangle, use.side, uses.size() > 2});
    });
    std::ranges::sort(rims_, {}, [](const Rim& rim) { return std::pair(rim.triangle, rim.side); });
    for (std::uint32_t r = 0; r < rims_.size(); ++r) beginning_[corner(r, 0)].push_back(r);
    for (const auto& [corner, rims] : beginning_)
      if (rims.size() > 1) normal_[corner] = Vector<3>::Zero();
    if (normal_.empty()) return;
    for (const FaceCorners& t : mesh.triangles)
      for (const std::uint32_t i : t)
        if (const auto found = normal_.find(i); found != normal_.end())
          found->second += doubled_area(mesh, t).stableNormalized();
  }

  std::size_t count() const { return rims_.size(); }
  std::uint32_t triangle(std::uint32_t r) const { return rims_[r].triangle; }
  /// The corner where it begins (0), where it ends (1), or the face's third corner (2).
  std::uint32_t corner(std::uint32_t r, int ahead) const {
    return mesh_.triangles[rims_[r].triangle][(rims_[r].side + ahead) % 3];
  }
  /// Three or more faces meet at the edge.
  bool branched(std::uint32_t r) const { return rims_[r].branched; }

  /// The next rim around the hole; none if all that begin there are used. If several begin, the first
  /// counterclockwise from the way back, seen from outside: the hole is on the right.
  std::uint32_t next(std::uint32_t r, const std::vector<bool>& walked) const {
    const std::uint32_t here = corner(r, 1);
    const auto found = beginning_.find(here);
    if (found == beginning_.end()) return no_index;
    if (found->second.size() == 1) return walked[found->second.front()] ? no_index : found->second.front();
    const Vector<3>&at = mesh_.vertices[here], &normal = normal_.at(here);
    const Vector<3> back = mesh_.vertices[corner(r, 0)] - at;
    const Vector<3> first = back - back.dot(normal) / normal.squaredNorm() * normal;
    const Vector<3> second = normal.stableNormalized().cross(first);
    std::uint32_t best = no_index;
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t other : found->second) {
      if (walked[other]) continue;
      const Vector<3> ahead = mesh_.vertices[corner(other, 1)] - at;
      double turn = std::atan2(ahead.dot(second), ahead.dot(first));
      if (turn <= 0) turn += 2 * std::numbers::pi;
      if (best == no_index || turn < least) best = other, least = turn;
    }
    return best;
  }

 private:
  struct Rim {
    std::uint32_t triangle;
    int side;
    bool branched;
  };

  const Mesh& mesh_;
  std::vector<Rim> rims_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> beginning_;  ///< by their first corner
  std::unordered_map<std::uint32_t, Vector<3>> normal_;  ///< for corners where several begin
};

double width_of(const Mesh& mesh, const std::vector<std::uint32_t>& corners) {
  auto bounds = Bounds<3>::of_nothing();
  for (const std::uint32_t v : corners) bounds.add(mesh.vertices[v]);
  return bounds.diagonal();
}

}  // namespace

std::vector<HoleLoop> hole_loops(const Mesh& mesh, const MeshTopology& topology) {
  const Rims rims(mesh);
  std::vector<HoleLoop> loops;
  using Path = std::vector<std::uint32_t>;
  const auto emit = [&](Path::const_iterator first, Path::const_iterator last) {
    HoleLoop loop;
    loop.component = topology.component[rims.triangle(*first)];
    for (auto r = last; r != first;) {  // the patch runs against the surrounding faces
      --r;
      loop.corners.push_back(rims.corner(*r, 1));
      loop.beyond.push_back(rims.corner(*r, 2));
      loop.branched |= rims.branched(*r);
    }
    loop.width = width_of(mesh, loop.corners);
    loops.push_back(std::move(loop));
  };
  std::vector<bool> walked(rims.count(), false);
  for (std::uint32_t start = 0; start < rims.count(); ++start) {
    Path path;
    std::unordered_map<std::uint32_t, std::size_t>
        position;  // in the path, of the rim that begins at a corner
    for (std::uint32_t r = start; r != no_index && !walked[r]; r = rims.next(r, walked)) {
      walked[r] = true;
      position[rims.corner(r, 0)] = path.size();
      path.push_back(r);
      if (const auto seen = position.find(rims.corner(r, 1)); seen != position.end()) {
        const std::size_t length = seen->second;
        const auto first = path.begin() + static_cast<std::ptrdiff_t>(length);
        emit(first, path.end());
        for (auto i = first; i != path.end(); ++i) position.erase(rims.corner(*i, 0));
        path.resize(length);
      }
    }
  }
  return loops;
}

Patcher::Patcher(Mesh& mesh) : mesh_(mesh) {
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) edges_.insert(key(t[k], t[(k + 1) % 3]));
}

std::uint64_t Patcher::key(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return (std::uint64_t{low} << 32) | high;
}

Vector<3> Patcher::across(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  return doubled_area(mesh_, {a, b, c});
}

/// Too thin for a reliable normal.
bool Patcher::is_thin(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  const auto squared = [&](std::uint32_t i, std::uint32_t j) {
    return (mesh_.vertices[i] - mesh_.vertices[j]).squaredNorm();
  };
  return across(a, b, c).norm() <= 1e-10 * std::max({squared(a, b), squared(b, c), squared(c, a)});
}

/// Whether no face is thin and no inner edge of the patch is an edge of the surface.
bool Patcher::is_allowed(const HoleLoop& loop, const Triangles& triangles) const {
  if (triangles.empty()) return false;
  std::unordered_set<std::uint64_t> rim;
  for (std::size_t k = 0; k < loop.corners.size(); ++k)
    rim.insert(key(loop.corners[k], loop.corners[(k + 1) % loop.corners.size()]));
  return std::none_of(triangles.begin(), triangles.end(), [&](const auto& t) {
    if (is_thin(t[0], t[1], t[2])) return true;
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t edge = key(t[k], t[(k + 1) % 3]);
      if (rim.count(edge) == 0 && edges_.count(edge) > 0) return true;
    }
    return false;
  });
}

Patcher::Triangles Patcher::seen_from_above(const HoleLoop& loop) const {
  const auto& corners = loop.corners;
  Vector<3> normal = Vector<3>::Zero(), middle = Vector<3>::Zero();
  for (const std::uint32_t i : corners) middle += mesh_.vertices[i] / static_cast<double>(corners.size());
  for (std::size_t k = 2; k < corners.size(); ++k) normal += across(corners[0], corners[k - 1], corners[k]);
  if (normal.norm() <= 1e-10 * loop.width * loop.width) return {};
  normal.normalize();
  double height = 0;
  for (const std::uint32_t i : corners)
    height = std::max(height, std::abs(normal.dot(mesh_.vertices[i] - middle)));
  if (height > flat_enough * loop.width && corners.size() <= most_searched) return {};
  Triangles triangles = triangulate(mesh_.vertices, corners);
  for (const auto& t : triangles)
    if (!(normal.dot(across(t[0], t[1], t[2])) > 0)) return {};
  return triangles;
}

Patcher::Triangles Patcher::least_bent(const HoleLoop& loop) const {
  const auto& corners = loop.corners;
  const std::size_t n = corners.size();
  if (n > most_searched) return {};
  struct Best {
    double bend = std::numeric_limits<double>::infinity();  ///< 1 - cos of the largest angle
    double area = std::numeric_limits<double>::infinity();
    std::size_t apex = 0;
    Vector<3> normal = Vector<3>::Zero();
  };
  // The best triangulation of corners i..j; for neighbours, the face beyond their edge.
  std::vector<Best> table(n * n);
  const auto best = [&](std::size_t i, std::size_t j) -> Best& { return table[i * n + j]; };
  const auto beyond = [&](std::size_t k) -> Vector<3> {
    return across(corners[(k + 1) % n], corners[k], loop.beyond[k]).stableNormalized();
  };
  for (std::size_t i = 0; i + 1 < n; ++i) best(i, i + 1) = {0, 0, i, beyond(i)};
  const Vector<3> last = beyond(n - 1);
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      const bool whole = span == n - 1;
      if (!whole && edges_.count(key(corners[i], corners[j])) > 0) continue;
      Best& found = best(i, j);
      for (std::size_t m = i + 1; m < j; ++m) {
        const Best &left = best(i, m), &right = best(m, j);
        if (std::max(left.bend, right.bend) > found.bend) continue;
        if (is_thin(corners[i], corners[m], corners[j])) continue;
        Vector<3> normal = across(corners[i], corners[m], corners[j]);
        const double length = normal.norm();
        normal /= length;
        double bend =
            std::max({left.bend, right.bend, 1 - normal.dot(left.normal), 1 - normal.dot(right.normal)});
        if (whole) bend = std::max(bend, 1 - normal.dot(last));
        const double area = left.area + right.area + length;
        // Angles that differ only by rounding are equal, so that the area decides on a plane.
        if (bend < found.bend - 1e-9 || (bend < found.bend + 1e-9 && area < found.area))
          found = {bend, area, m, normal};
      }
    }
  }
  if (!std::isfinite(best(0, n - 1).area)) return {};
  Triangles triangles;
  std::vector<std::array<std::size_t, 2>> open = {{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t m = best(i, j).apex;
    triangles.push_back({corners[i], corners[m], corners[j]});
    open.push_back({i, m});
    open.push_back({m, j});
  }
  return triangles;
}

Patcher::Triangles Patcher::around_middle(const HoleLoop& loop) {
  const auto& corners = loop.corners;
  const auto middle = static_cast<std::uint32_t>(mesh_.vertices.size());
  Vector<3> sum = Vector<3>::Zero();
  for (const std::uint32_t i : corners) sum += mesh_.vertices[i] / static_cast<double>(corners.size());
  mesh_.vertices.push_back(sum);
  Triangles triangles;
  for (std::size_t k = 0; k < corners.size(); ++k)
    triangles.push_back({corners[k], corners[(k + 1) % corners.size()], middle});
  return triangles;
}

bool Patcher::fill(const HoleLoop& loop) {
  if (loop.corners.size() < 3) return false;
  Triangles triangles;
  if (loop.corners.size() == 3) {
    triangles = {{loop.corners[0], loop.corners[1], loop.corners[2]}};
    // A single face without neighbours is not a hole.
    if (loop.beyond == std::vector{loop.corners[2], loop.corners[0], loop.corners[1]}) return false;
  } else {
    triangles = seen_from_above(loop);
    if (!is_allowed(loop, triangles)) triangles = least_bent(loop);
  }
  if (!is_allowed(loop, triangles)) {
    triangles = around_middle(loop);
    if (!is_allowed(loop, triangles)) {
      mesh_.vertices.pop_back();
      return false;
    }
  }
  for (const auto& t : triangles) {
    mesh_.triangles.push_back(t);
    for (int k = 0; k < 3; ++k) edges_.insert(key(t[k], t[(k + 1) % 3]));
  }
  return true;
}

}  // namespace bernal::cad
