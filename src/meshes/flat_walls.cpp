#include "meshes/flat_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "bernal/cad/mesh_container.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/edges.hpp"
#include "geometry/measures.hpp"
#include "meshes/neck_shape.hpp"
#include "solids/flat_faces.hpp"

namespace bernal {
namespace {

constexpr double tolerance_of_diagonal = 1e-7;
/// A bridge that has less room than this share of the radius asked for gives way to a gap.
constexpr double least_foot = 0.5;

double distance_to_line(const Vector<3>& p, const Vector<3>& a, const Vector<3>& b) {
  const Vector<3> along = b - a;
  const double length = along.norm();
  return length > 0 ? (p - a).cross(along).norm() / length : (p - a).norm();
}

/// Distance of p from what of a triangle is not beyond the plane through p, by more than rounding.
double distance_before_plane(const Facet& facet, const Vector<3>& p, const Vector<3>& outward,
                             double rounding) {
  const std::array<Vector<3>, 3> corners = {facet.a, facet.b, facet.c};
  std::vector<Vector<3>> left;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector<3>&from = corners[k], &to = corners[(k + 1) % 3];
    const double a = (from - p).dot(outward) - rounding, b = (to - p).dot(outward) - rounding;
    if (a <= 0) left.push_back(from);
    if ((a <= 0) != (b <= 0)) left.push_back(from + a / (a - b) * (to - from));
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < left.size(); ++k) {
    Facet piece = facet;
    piece.a = left[0];
    piece.b = left[k];
    piece.c = left[(k + 1) % left.size()];
    least = std::min(least, (closest_point(piece, p) - p).norm());
  }
  return least;
}

/// Joins runs of edges between the same two parts to straight ones.
class StraightEdges {
 public:
  StraightEdges(const Mesh& mesh, const std::vector<std::uint32_t>& part, double tolerance)
      : mesh_(mesh), tolerance_(tolerance), at_(mesh.vertices.size()) {
    MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
      for (std::size_t k = 0; k + 1 < uses.size(); k += 2) {
        const std::uint32_t one = part[uses[k].triangle], other = part[uses[k + 1].triangle];
        if (one == other) continue;
        const auto number = static_cast<std::uint32_t>(given_.size());
        given_.push_back({{uses[k].low, uses[k].high}, {std::min(one, other), std::max(one, other)}});
        at_[uses[k].low].push_back(number);
        at_[uses[k].high].push_back(number);
      }
    });
  }

  std::vector<FlatEdge> made() {
    taken_.assign(given_.size(), false);
    // Lines from where edges meet or bend, and then those that are left, which are closed.
    for (const bool from_corners : {true, false})
      for (std::uint32_t e = 0; e < given_.size(); ++e)
        for (const std::uint32_t corner : given_[e].corners)
          if (!taken_[e] && (!from_corners || is_end(corner))) follow(e, corner);
    return std::move(edges_);
  }

 private:
  bool is_end(std::uint32_t v) const {
    if (at_[v].size() != 2) return true;
    const FlatEdge &one = given_[at_[v][0]], &other = given_[at_[v][1]];
    if (one.parts != other.parts) return true;
    const Vector<3>&a = mesh_.vertices[beyond(one, v)], &b = mesh_.vertices[beyond(other, v)];
    return distance_to_line(mesh_.vertices[v], a, b) > tolerance_ ||
           (a - mesh_.vertices[v]).dot(b - mesh_.vertices[v]) > 0;
  }
  static std::uint32_t beyond(const FlatEdge& edge, std::uint32_t v) {
    return edge.corners[edge.corners[0] == v ? 1 : 0];
  }

  void follow(std::uint32_t edge, std::uint32_t from) {
    std::vector<std::uint32_t> line{from};
    const auto parts = given_[edge].parts;
    for (;;) {
      taken_[edge] = true;
      const std::uint32_t to = beyond(given_[edge], line.back());
      line.push_back(to);
      if (is_end(to) || to == from) break;
      edge = at_[to][at_[to][0] == edge ? 1 : 0];
      if (taken_[edge]) break;
    }
    for (std::size_t first = 0; first + 1 < line.size();) {
      std::size_t last = first + 1;
      while (last + 1 < line.size() && is_straight(line, first, last + 1)) ++last;
      edges_.push_back({{line[first], line[last]}, parts});
      first = last;
    }
  }

  bool is_straight(const std::vector<std::uint32_t>& line, std::size_t first, std::size_t last) const {
    const Vector<3>&a = mesh_.vertices[line[first]], &b = mesh_.vertices[line[last]];
    for (std::size_t k = first + 1; k < last; ++k) {
      const Vector<3>& p = mesh_.vertices[line[k]];
      if (distance_to_line(p, a, b) > tolerance_ || (p - a).dot(b - p) < 0) return false;
    }
    return true;
  }

  const Mesh& mesh_;
  double tolerance_;
  std::vector<FlatEdge> given_, edges_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::vector<bool> taken_;
};

}  // namespace

PlanarWalls flat_walls_of(const Mesh& mesh) {
  PlanarWalls walls;
  walls.tolerance = tolerance_of_diagonal * bounds_of(mesh).diagonal();
  FlatGroups groups = flat_groups_of(mesh, topology_of(mesh), walls.tolerance);
  for (const std::vector<std::uint32_t>& members : groups.members) {
    const FaceCorners& largest = mesh.triangles[members.front()];
    FlatPart& part = walls.parts.emplace_back();
    part.outward = doubled_area(mesh, largest).normalized();
    part.u = part.outward.unitOrthogonal();
    part.v = part.outward.cross(part.u);
    Bounds<3> bounds = bounds_of(mesh, largest);
    for (const std::uint32_t t : members) {
      const Bounds<3> of = bounds_of(mesh, mesh.triangles[t]);
      bounds = {bounds.lower.cwiseMin(of.lower), bounds.upper.cwiseMax(of.upper)};
    }
    const Vector<3>& on = mesh.vertices[largest[0]];
    part.origin = bounds.center() - (bounds.center() - on).dot(part.outward) * part.outward;
  }
  walls.part_of_triangle = std::move(groups.of_triangle);
  walls.edges = StraightEdges(mesh, walls.part_of_triangle, walls.tolerance).made();
  return walls;
}

FlatFeet::FlatFeet(const Mesh& mesh, const PlanarWalls& walls, std::shared_ptr<const Container> container)
    : walls_(walls), frame_(frame_of(Domain(mesh))), container_(std::move(container)) {}

std::vector<FlatFeet::Foot> FlatFeet::near(const Vector<3>& c, double r, double reach) const {
  std::vector<NearFacet> facets;
  const Vector<3> at = frame_.to_local(c);
  const double around = 0.5 * r, farthest = std::hypot(reach, around);
  container_->facets_near(at, farthest / frame_.scale, facets);
  struct Nearest {
    double distance;
    Vector<3> point;
  };
  std::map<std::uint32_t, Nearest> of_part;
  for (const NearFacet& near : facets) {
    if (!(near.distance * frame_.scale < reach)) continue;
    const std::uint32_t part = walls_.part_of_triangle[near.facet.id];
    const Vector<3> point = closest_point(near.facet, at);
    if ((point - at).dot(walls_.parts[part].outward) <= 0) continue;  // the far side of something thin
    const auto [entry, is_new] = of_part.try_emplace(part, Nearest{near.distance, point});
    if (!is_new && near.distance < entry->second.distance) entry->second = {near.distance, point};
  }
  std::vector<Foot> feet;
  for (const auto& [part, nearest] : of_part) {
    double room = around / frame_.scale;
    for (const NearFacet& other : facets)
      if (walls_.part_of_triangle[other.facet.id] != part)
        room = std::min(room, distance_before_plane(other.facet, nearest.point, walls_.parts[part].outward,
                                                    walls_.tolerance / frame_.scale));
    feet.push_back({part, nearest.distance * frame_.scale, room * frame_.scale});
  }
  return feet;
}

double FlatFeet::radius_in(const Foot& foot, double asked, double edge) {
  const double radius = std::min(asked, foot.room - 0.5 * edge);
  return radius >= least_foot * asked ? radius : 0;
}

namespace {

SolidsInWalls solids_in_facets(const Spheres<dynamic>& spheres, const Revolved& round,
                               const SolidsOptions& options, double neck_edge, const Monitor& monitor) {
  constexpr double deviation = 0.02;  // of a radius
  constexpr double most_sides = 20000;
  const double sides =
      std::min(most_sides, sides_for(round, deviation * (spheres.empty() ? 1 : std::ranges::min(spheres.r))));
  SolidsInWalls made =
      solids_in_walls(spheres, surface_of(round, static_cast<int>(sides), RoundAs::circumscribed), options,
                      neck_edge, monitor);
  double largest = 0;
  for (const Vector<2>& corner : round.profile) largest = std::max(largest, corner[0]);
  made.wall_deviation = largest * (1 / std::cos(std::numbers::pi / sides) - 1);
  return made;
}

}  // namespace

SolidsInWalls solids_in_walls(const Spheres<dynamic>& spheres, const Domain& domain,
                              const SolidsOptions& options, double neck_edge, const Monitor& monitor) {
  if (const auto* revolved = std::get_if<Revolved>(&domain); revolved != nullptr && revolved->inset == 0)
    return solids_in_facets(spheres, *revolved, options, neck_edge, monitor);
  const auto* mesh = std::get_if<Mesh>(&domain);
  if (mesh == nullptr || !joins(options.contact)) return {solids_of(spheres, domain, options, monitor)};
  SolidsInWalls made;
  Spheres<dynamic> smaller = spheres;
  const PlanarWalls walls = flat_walls_of(*mesh);
  const FlatFeet feet(*mesh, walls, local_container(domain, nullptr));
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i], reach = (1 + options.gap) * r;
    double nearest = std::numeric_limits<double>::infinity();
    bool has_room = true;
    for (const FlatFeet::Foot& foot : feet.near(spheres.center(i), r, reach)) {
      nearest = std::min(nearest, foot.distance);
      const NeckEnds ends{r, {}, std::max(foot.distance, r)};
      const bool is_fillet = options.contact == ContactTreatment::fillet;
      double asked = options.bridge_angle > 0 ? radius_for_angle(ends, options.bridge_angle, is_fillet)
                                              : options.bridge_radius * r;
      if (is_fillet) asked = fillet_between(ends, asked).rims[1];
      has_room = has_room && FlatFeet::radius_in(foot, asked, neck_edge * r) > 0;
    }
    if (has_room) continue;
    constexpr double rounding = 1e-12;
    smaller.r[i] = nearest / (1 + options.gap) * (1 - rounding);
    ++made.gaps_at_edges;
    made.largest_shrink = std::max(made.largest_shrink, 1 - smaller.r[i] / r);
  }
  SolidsOptions given = options;
  given.shells = scaled(options.shells, spheres, smaller);
  made.solids = solids_of(smaller, domain, given, monitor);
  return made;
}

}  // namespace bernal
