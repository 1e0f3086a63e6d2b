#include "meshes/smooth_walls.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/order.hpp"
#include "geometry/edges.hpp"
#include "geometry/measures.hpp"

namespace bernal {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double largest_bend = 20 * degree;    // over an edge that is triangulated across
constexpr double largest_slope = 25 * degree;   // of a part, from the one that a smooth part began with
constexpr double slope_of_rests = 38 * degree;  // of parts that would be left alone
constexpr double most_between_widths = 4;

double angle_between(const Vector<3>& a, const Vector<3>& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The longest edge of triangles that stays within a tolerance of a line that bends by this angle every
/// `width`: of the circle through its corners, of radius R = width / bend, the chord with the rise h² / (8
/// R).
double longest_over(double bend, double width, double tolerance) {
  return bend > 0 ? std::sqrt(8 * tolerance * width / bend) : std::numeric_limits<double>::infinity();
}

/// Joins planar parts.
class Joining {
 public:
  Joining(const Mesh& mesh, const PlanarWalls& walls, double tolerance, const std::vector<char>& keep_apart)
      : mesh_(mesh), walls_(walls), tolerance_(tolerance), beside_(walls.parts.size()) {
    made_.longest.assign(walls.parts.size(), std::numeric_limits<double>::infinity());
    measure();
    for (const FlatEdge& edge : walls_.edges) {
      const auto [p, q] = edge.parts;
      if (keep_apart[p] || keep_apart[q]) continue;
      const double bend = angle_between(walls_.parts[p].outward, walls_.parts[q].outward);
      const double narrow = std::min(width_[p], width_[q]), wide = std::max(width_[p], width_[q]);
      if (!(narrow > 0) || bend > largest_bend || 0.25 * bend * narrow > tolerance_ ||
          wide > most_between_widths * narrow)
        continue;
      beside_[p].push_back(q);
      beside_[q].push_back(p);
      for (const std::uint32_t part : {p, q})
        made_.longest[part] = std::min(made_.longest[part], longest_over(bend, narrow, tolerance_));
    }
  }

  SmoothWalls made() {
    join();
    join_rests();
    number();
    for (std::size_t p = 0; p < walls_.parts.size(); ++p)
      if (made_.parts[made_.of_flat_part[p]].is_planar())
        made_.longest[p] = std::numeric_limits<double>::infinity();
    return std::move(made_);
  }

 private:
  void measure() {
    area_.assign(walls_.parts.size(), 0);
    std::vector<Bounds<3>> bounds(walls_.parts.size(), Bounds<3>::of_nothing());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const std::uint32_t p = walls_.part_of_triangle[t];
      area_[p] += 0.5 * doubled_area(mesh_, mesh_.triangles[t]).norm();
      for (const std::uint32_t corner : mesh_.triangles[t]) bounds[p].add(mesh_.vertices[corner]);
    }
    for (std::size_t p = 0; p < area_.size(); ++p) width_.push_back(area_[p] / bounds[p].diagonal());
  }

  bool faces(std::uint32_t part, std::uint32_t seed, double slope) const {
    return angle_between(walls_.parts[part].outward, walls_.parts[seed].outward) <= slope;
  }

  void join() {
    made_.of_flat_part.assign(walls_.parts.size(), no_index);
    for (const std::uint32_t seed : largest_first(area_)) {
      if (made_.of_flat_part[seed] != no_index) continue;
      const auto own = static_cast<std::uint32_t>(made_.parts.size());
      SmoothPart& joined = made_.parts.emplace_back(SmoothPart{walls_.parts[seed], {seed}});
      made_.of_flat_part[seed] = own;
      for (std::size_t m = 0; m < joined.parts.size(); ++m)
        for (const std::uint32_t other : beside_[joined.parts[m]]) {
          if (made_.of_flat_part[other] != no_index || !faces(other, seed, largest_slope)) continue;
          made_.of_flat_part[other] = own;
          joined.parts.push_back(other);
        }
    }
  }

  /// Those made last, of what others left, become parts of these where they face nearly their way.
  void join_rests() {
    for (auto own = static_cast<std::uint32_t>(made_.parts.size()); own-- > 0;) {
      std::vector<std::uint32_t>& rest = made_.parts[own].parts;
      std::uint32_t best = no_index;
      for (const std::uint32_t part : rest)
        for (const std::uint32_t other : beside_[part]) {
          const std::uint32_t to = made_.of_flat_part[other];
          if (to >= own || to == best) continue;
          const bool all = std::ranges::all_of(
              rest, [&](std::uint32_t p) { return faces(p, made_.parts[to].parts.front(), slope_of_rests); });
          if (all) best = std::min(best, to);
        }
      if (best == no_index) continue;
      for (const std::uint32_t part : rest) made_.of_flat_part[part] = best;
      made_.parts[best].parts.insert(made_.parts[best].parts.end(), rest.begin(), rest.end());
      rest.clear();
    }
  }

  void number() {
    std::vector<SmoothPart> kept;
    for (SmoothPart& part : made_.parts) {
      if (part.parts.empty()) continue;
      for (const std::uint32_t p : part.parts)
        made_.of_flat_part[p] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(std::move(part));
    }
    made_.parts = std::move(kept);
  }

  const Mesh& mesh_;
  const PlanarWalls& walls_;
  double tolerance_;
  std::vector<double> area_, width_;
  std::vector<std::vector<std::uint32_t>> beside_;  ///< parts that a part may be joined to
  SmoothWalls made_;
};

/// Lines of the edges that are left between smooth parts.
class Lines {
 public:
  Lines(const Mesh& mesh, const PlanarWalls& walls, SmoothWalls& made, double tolerance)
      : mesh_(mesh), walls_(walls), made_(made), tolerance_(tolerance), at_(mesh.vertices.size()) {
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e) {
      if (parts_of(e)[0] == parts_of(e)[1]) continue;
      for (const std::uint32_t corner : walls_.edges[e].corners) at_[corner].push_back(e);
    }
  }

  void make() {
    taken_.assign(walls_.edges.size(), false);
    for (const bool from_corners : {true, false})
      for (std::uint32_t e = 0; e < walls_.edges.size(); ++e) {
        if (parts_of(e)[0] == parts_of(e)[1]) continue;
        for (const std::uint32_t corner : walls_.edges[e].corners)
          if (!taken_[e] && (!from_corners || is_end(corner))) follow(e, corner);
      }
  }

 private:
  std::array<std::uint32_t, 2> parts_of(std::uint32_t e) const {
    const auto [p, q] = walls_.edges[e].parts;
    const std::uint32_t a = made_.of_flat_part[p], b = made_.of_flat_part[q];
    return {std::min(a, b), std::max(a, b)};
  }
  std::uint32_t beyond(std::uint32_t e, std::uint32_t v) const {
    const auto& corners = walls_.edges[e].corners;
    return corners[corners[0] == v ? 1 : 0];
  }
  struct Bend {
    double angle, shorter;
  };
  Bend bend_at(std::uint32_t v, std::uint32_t e, std::uint32_t f) const {
    const Vector<3> in = mesh_.vertices[v] - mesh_.vertices[beyond(e, v)],
                    out = mesh_.vertices[beyond(f, v)] - mesh_.vertices[v];
    return {angle_between(in, out), std::min(in.norm(), out.norm())};
  }
  bool is_end(std::uint32_t v) const {
    if (at_[v].size() != 2 || parts_of(at_[v][0]) != parts_of(at_[v][1])) return true;
    const auto parts = parts_of(at_[v][0]);
    if (made_.parts[parts[0]].is_planar() && made_.parts[parts[1]].is_planar()) return true;
    const Bend bend = bend_at(v, at_[v][0], at_[v][1]);
    return bend.angle > largest_bend || 0.25 * bend.angle * bend.shorter > tolerance_;
  }

  void follow(std::uint32_t edge, std::uint32_t from) {
    std::vector<std::uint32_t> line{from}, edges;
    for (;;) {
      taken_[edge] = true;
      edges.push_back(edge);
      const std::uint32_t to = beyond(edge, line.back());
      line.push_back(to);
      if (is_end(to) || to == from) break;
      edge = at_[to][at_[to][0] == edge ? 1 : 0];
      if (taken_[edge]) break;
    }
    // A closed line has three corners.
    const std::size_t n = edges.size(),
                      pieces = line.front() == line.back() ? std::min<std::size_t>(3, n) : 1;
    for (std::size_t k = 0; k < pieces; ++k) add(line, edges, k * n / pieces, (k + 1) * n / pieces);
  }

  void add(const std::vector<std::uint32_t>& line, const std::vector<std::uint32_t>& edges, std::size_t first,
           std::size_t last) {
    SmoothEdge& made = made_.edges.emplace_back();
    made.parts = parts_of(edges[first]);
    made.line = {line[first]};
    made.along = {0};
    for (std::size_t k = first; k < last; ++k) {
      made.line.push_back(line[k + 1]);
      made.along.push_back(made.along.back() +
                           (mesh_.vertices[line[k + 1]] - mesh_.vertices[line[k]]).norm());
      made.flat_parts.push_back(walls_.edges[edges[k]].parts);
      if (k == first) continue;
      const Bend bend = bend_at(line[k], edges[k - 1], edges[k]);
      made.longest = std::min(made.longest, longest_over(bend.angle, bend.shorter, tolerance_));
    }
  }

  const Mesh& mesh_;
  const PlanarWalls& walls_;
  SmoothWalls& made_;
  double tolerance_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::vector<bool> taken_;
};

Vector<2> in_plane(const Vector<3>& p) { return p.head<2>(); }

/// The point of a segment that is nearest to q, as a share.
double share_of_nearest(const Vector<2>& a, const Vector<2>& b, const Vector<2>& q) {
  const Vector<2> d = b - a;
  const double squared = d.squaredNorm();
  return squared > 0 ? std::clamp((q - a).dot(d) / squared, 0.0, 1.0) : 0.0;
}

}  // namespace

std::size_t SmoothEdge::piece_at(double share) const {
  const auto after = std::ranges::lower_bound(along.begin() + 1, along.end() - 1, share * length());
  return static_cast<std::size_t>(after - along.begin()) - 1;
}

Vector<3> SmoothEdge::at(const Mesh& mesh, double share) const {
  const std::size_t k = piece_at(share);
  const Vector<3>&a = mesh.vertices[line[k]], &b = mesh.vertices[line[k + 1]];
  return a + (share * length() - along[k]) / (along[k + 1] - along[k]) * (b - a);
}

SmoothWalls smooth_walls_of(const Mesh& mesh, const PlanarWalls& walls, double tolerance,
                            const std::vector<char>& keep_apart) {
  SmoothWalls made = Joining(mesh, walls, tolerance, keep_apart).made();
  Lines(mesh, walls, made, tolerance).make();
  return made;
}

SmoothSurface::SmoothSurface(const Mesh& mesh, const SmoothPart& part,
                             const std::vector<std::vector<std::uint32_t>>& triangles_of_flat_part)
    : frame_(part.frame) {
  axes_ << frame_.u, frame_.v, frame_.outward;
  std::vector<Bounds<2>> boxes;
  for (const std::uint32_t p : part.parts)
    for (const std::uint32_t t : triangles_of_flat_part[p]) {
      Triangle triangle{.corners = {}, .flat_part = p};
      Bounds<2> box = Bounds<2>::of_nothing();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector<3>& corner = mesh.vertices[mesh.triangles[t][k]];
        triangle.corners[k] = {on(0, corner), on(1, corner), on(2, corner)};
        box.add(in_plane(triangle.corners[k]));
        extent_ = std::max(extent_, in_plane(triangle.corners[k]).norm());
      }
      triangles_.push_back(triangle);
      boxes.push_back(box);
    }
  tree_ = BoxTree<2>(boxes, 4);
}

SmoothSurface::Place SmoothSurface::over(const Vector<3>& at) const {
  const Vector<2> q = in_plane(at);
  double least = std::numeric_limits<double>::infinity(), height = 0;
  std::uint32_t nearest = no_index;
  const auto consider = [&](std::uint32_t t) {
    const auto& c = triangles_[t].corners;
    std::array<double, 3> twice{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector<2> a = in_plane(c[(k + 1) % 3]) - q, b = in_plane(c[(k + 2) % 3]) - q;
      twice[k] = a[0] * b[1] - a[1] * b[0];
    }
    const double whole = twice[0] + twice[1] + twice[2];
    double distance = std::numeric_limits<double>::infinity(), z = 0;
    if (whole > 0 && std::ranges::all_of(twice, [](double x) { return x >= 0; })) {
      distance = 0;
      z = (twice[0] * c[0][2] + twice[1] * c[1][2] + twice[2] * c[2][2]) / whole;
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector<3>&a = c[k], &b = c[(k + 1) % 3];
        const double share = share_of_nearest(in_plane(a), in_plane(b), q);
        const double from = (in_plane(Vector<3>(a + share * (b - a))) - q).norm();
        if (!(from < distance)) continue;
        distance = from;
        z = a[2] + share * (b[2] - a[2]);
      }
    }
    if (!(distance < least || (distance == least && t < nearest))) return;
    least = distance;
    nearest = t;
    height = z;
  };
  for (double reach = 1e-9 * extent_; nearest == no_index || least > reach; reach *= 8) {
    if (reach > 1e3 * extent_) break;
    tree_.for_each_near(q, reach, consider);
  }
  return {frame_.origin + axes_ * Vector<3>(q[0], q[1], height), height, triangles_[nearest].flat_part};
}

}  // namespace bernal
