#include "meshes/flat_wall_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/parallel.hpp"

namespace bernal {
namespace {

/// A piece of an edge is at most so many times as long as points of its parts are far from it.
constexpr double most_per_distance = 1.6;
/// No pieces are made shorter than that for other points' sake, of the size at the place.
constexpr double least_piece = 0.03;
constexpr double acute_cosine = 0.5;  // 60 degrees

class FlatEdgePoints {
 public:
  FlatEdgePoints(SurfaceDraft& draft, const SmoothWalls& walls, const Mesh& mesh)
      : draft_(draft), walls_(walls), mesh_(mesh), of_part_(walls.parts.size()) {
    vertex_.assign(mesh.vertices.size(), Delaunay::none);
    acute_.resize(walls.edges.size());
    points_when_checked_.assign(walls.edges.size(), 0);
  }

  std::vector<std::vector<std::uint32_t>> made() {
    find_acute_corners();
    add_corners_and_feet();
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e) divide_by_size(e);
    while (divide_by_others()) continue;
    std::vector<std::vector<std::uint32_t>> chains(walls_.edges.size());
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e)
      for (const auto& [share, id] : on_edge_[e]) chains[e].push_back(id);
    return chains;
  }

 private:
  static constexpr std::uint32_t no_edge = Delaunay::none;
  struct Point {
    std::uint32_t id;
    std::uint32_t edge;  ///< that it lies within, or no_edge
  };
  /// Points of a part, sorted along its longer direction.
  struct PartPoints {
    Vector<3> along = Vector<3>::UnitX();
    std::multimap<double, Point> points;
  };

  const Vector<3>& place(std::uint32_t id) const { return draft_.made.vertices[id]; }
  std::uint32_t corner(std::uint32_t e, std::size_t k) const { return walls_.edges[e].corners()[k]; }
  const FlatPart& frame(std::uint32_t part) const { return walls_.parts[part].frame; }

  double size_at(std::uint32_t e, double share) const {
    const SmoothEdge& edge = walls_.edges[e];
    const Vector<3> p = edge.at(mesh_, share);
    double size = edge.longest;
    for (const std::uint32_t part : edge.flat_parts[edge.piece_at(share)])
      size = std::min({size, walls_.longest[part],
                       draft_.sizes.on_wall(p, draft_.flat_walls->parts[part].outward, false)});
    return size;
  }

  void find_acute_corners() {
    std::vector<std::vector<std::uint32_t>> at(mesh_.vertices.size());
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e)
      for (const std::uint32_t corner : walls_.edges[e].corners()) at[corner].push_back(e);
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e)
      for (std::size_t k = 0; k < 2; ++k)
        for (const std::uint32_t f : at[corner(e, k)])
          if (f != e && shares_part(e, f) && cosine_at(corner(e, k), e, f) > acute_cosine)
            acute_[e][k] = true;
  }
  bool shares_part(std::uint32_t e, std::uint32_t f) const {
    const auto &one = walls_.edges[e].parts, &other = walls_.edges[f].parts;
    return std::ranges::find_first_of(one, other) != one.end();
  }
  double cosine_at(std::uint32_t corner, std::uint32_t e, std::uint32_t f) const {
    const auto beyond = [&](std::uint32_t edge) {
      const auto& line = walls_.edges[edge].line;
      const std::uint32_t next = line.front() == corner ? line[1] : line[line.size() - 2];
      return Vector<3>((mesh_.vertices[next] - mesh_.vertices[corner]).normalized());
    };
    return beyond(e).dot(beyond(f));
  }

  void add_corners_and_feet() {
    std::vector<Bounds<3>> bounds(walls_.parts.size(), Bounds<3>::of_nothing());
    for (const SmoothEdge& edge : walls_.edges)
      for (const std::uint32_t part : edge.parts)
        for (const std::uint32_t vertex : edge.line) {
          const Vector<3> d = mesh_.vertices[vertex] - frame(part).origin;
          bounds[part].add({d.dot(frame(part).u), d.dot(frame(part).v), 0});
        }
    for (std::uint32_t p = 0; p < bounds.size(); ++p) {
      const Vector<3> size = bounds[p].size();
      of_part_[p].along = size[0] > size[1] ? frame(p).u : frame(p).v;
    }
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e) {
      for (std::size_t k = 0; k < 2; ++k) {
        std::uint32_t& id = vertex_[corner(e, k)];
        if (id == Delaunay::none)
          id = draft_.add_vertex(mesh_.vertices[corner(e, k)], size_at(e, static_cast<double>(k)));
        for (const std::uint32_t part : walls_.edges[e].parts) add_to(part, {id, no_edge});
      }
      on_edge_.push_back({{0.0, vertex_[corner(e, 0)]}, {1.0, vertex_[corner(e, 1)]}});
    }
    for (const DraftNeck& neck : draft_.necks)
      if (neck.wall)
        for (const std::uint32_t id : neck.rim_points[1]) add_to(walls_.of_flat_part[*neck.wall], {id, no_edge});
  }

  void add_to(std::uint32_t part, const Point& point) {
    PartPoints& of = of_part_[part];
    of.points.emplace((place(point.id) - frame(part).origin).dot(of.along), point);
  }

  void add_on(std::uint32_t e, double share) {
    const std::uint32_t id = draft_.add_vertex(walls_.edges[e].at(mesh_, share), size_at(e, share));
    on_edge_[e].emplace(share, id);
    const auto& parts = walls_.edges[e].parts;
    add_to(parts[0], {id, e});
    if (parts[1] != parts[0]) add_to(parts[1], {id, e});
  }

  void divide_by_size(std::uint32_t e) {
    throw_if_interrupted();
    const double length = walls_.edges[e].length();
    const auto size = [&](double share) { return size_at(e, share); };
    if (!acute_[e][0] && !acute_[e][1]) {
      for (const double share : spaced(length, 1, size)) add_on(e, share);
      return;
    }
    std::vector<std::array<double, 2>> open{{0.0, 1.0}};
    while (!open.empty()) {
      const auto [a, b] = open.back();
      open.pop_back();
      if ((b - a) * length <= size(0.5 * (a + b))) continue;
      const double middle = where_to_cut(e, a, b);
      add_on(e, middle);
      open.push_back({a, middle});
      open.push_back({middle, b});
    }
  }

  /// The share at which a piece of an edge is cut: in the middle, or near an acute corner at a power of 2.
  double where_to_cut(std::uint32_t e, double a, double b) const {
    const double length = walls_.edges[e].length();
    const bool is_from_lower = acute_[e][0] && (!acute_[e][1] || a + b <= 1);
    if (!is_from_lower && !acute_[e][1]) return 0.5 * (a + b);
    if (acute_[e][0] && acute_[e][1] && a == 0 && b == 1) return 0.5;
    const double nearer = is_from_lower ? a : 1 - b, farther = is_from_lower ? b : 1 - a;
    const double middle = 0.5 * (nearer + farther) * length;
    double shell = std::exp2(std::nearbyint(std::log2(middle)));
    const double quarter = 0.25 * (farther - nearer) * length;
    if (shell < nearer * length + quarter || shell > farther * length - quarter) shell = middle;
    return is_from_lower ? shell / length : 1 - shell / length;
  }

  /// Only edges whose parts got points since are looked at: along narrow parts a point asks for the next.
  bool divide_by_others() {
    bool has_changed = false;
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e) {
      std::size_t given = 0;
      for (const std::uint32_t part : walls_.edges[e].parts) given += of_part_[part].points.size();
      if (given == points_when_checked_[e]) continue;
      points_when_checked_[e] = given;
      throw_if_interrupted();
      const std::vector<std::pair<double, std::uint32_t>> points(on_edge_[e].begin(), on_edge_[e].end());
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        if (!is_too_long(e, points[k].second, points[k + 1].second)) continue;
        add_on(e, where_to_cut(e, points[k].first, points[k + 1].first));
        has_changed = true;
      }
    }
    return has_changed;
  }

  bool is_too_long(std::uint32_t e, std::uint32_t from, std::uint32_t to) const {
    const Vector<3> a = place(from), span = place(to) - a, middle = a + 0.5 * span;
    const double length = span.norm();
    if (!(length > 2 * least_piece * std::min(draft_.made.size[from], draft_.made.size[to]))) return false;
    const double reach = length / most_per_distance;
    const auto is_near = [&](const Point& point) {
      if (point.id == from || point.id == to) return false;
      const Vector<3> d = place(point.id) - a;
      const double along = std::clamp(d.dot(span) / (length * length), 0.0, 1.0);
      const double distance = (d - along * span).norm();
      return distance < reach && distance < reach * sine_between(e, point);
    };
    for (const std::uint32_t part : walls_.edges[e].parts) {
      const PartPoints& of = of_part_[part];
      const double at = (middle - frame(part).origin).dot(of.along);
      const double half = 0.5 * std::abs(span.dot(of.along)) + reach;
      for (auto p = of.points.lower_bound(at - half); p != of.points.end() && p->first <= at + half; ++p)
        if (is_near(p->second)) return true;
    }
    return false;
  }

  /// Of the angle between edges that meet in a corner, where this is acute; else 1.
  double sine_between(std::uint32_t e, const Point& point) const {
    if (point.edge == no_edge || point.edge == e) return 1;
    const auto others = walls_.edges[point.edge].corners();
    for (const std::uint32_t corner : walls_.edges[e].corners())
      if (std::ranges::find(others, corner) != others.end()) {
        const double cosine = cosine_at(corner, e, point.edge);
        if (cosine > acute_cosine) return std::sqrt(std::max(0.0, 1 - cosine * cosine));
      }
    return 1;
  }

  SurfaceDraft& draft_;
  const SmoothWalls& walls_;
  const Mesh& mesh_;
  std::vector<std::uint32_t> vertex_;  ///< of corners
  std::vector<std::array<bool, 2>> acute_;
  std::vector<std::map<double, std::uint32_t>> on_edge_;  ///< by share of the edge
  std::vector<PartPoints> of_part_;
  std::vector<std::size_t> points_when_checked_;  ///< of an edge, in its parts
};

}  // namespace

std::vector<std::vector<std::uint32_t>> points_on_flat_edges(SurfaceDraft& draft, const SmoothWalls& walls,
                                                             const Mesh& mesh) {
  return FlatEdgePoints(draft, walls, mesh).made();
}

}  // namespace bernal
