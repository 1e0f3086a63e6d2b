#include "cad/repair/hollows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "bernal/core/error.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/cgal_surfaces.hpp"
#include "cad/repair/lids.hpp"
#include "cad/repair/surface_pieces.hpp"
#include "core/parallel.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {
namespace {

/// The convex hull of the faces' corners; absent if they are coplanar.
std::optional<Mesh> hull_of_faces(const Mesh& mesh, const std::vector<std::uint32_t>& faces) {
  std::vector<Vector<3>> points;
  for (const std::uint32_t t : faces)
    for (const std::uint32_t v : mesh.triangles[t]) points.push_back(mesh.vertices[v]);
  return convex_hull_of(points);
}

/// The volume of a polytope around the faces' corners, by a few per cent larger than that of their hull; the
/// hull itself takes minutes where as good as all of many corners are on it, as those of a ball. Infinite if
/// they are nearly coplanar.
double volume_around(const Mesh& mesh, const std::vector<std::uint32_t>& faces) {
  constexpr int directions = 256;
  Mesh piece{mesh.vertices, {}};
  for (const std::uint32_t t : faces) piece.triangles.push_back(mesh.triangles[t]);
  drop_unused_vertices(piece);
  const Bounds<3> bounds = bounds_of(piece);
  const Vector<3> middle = bounds.center();
  std::vector<Vector<3>> normals(directions), corners;
  std::vector<double> reach(directions, 0);
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));  // even on the sphere
  for (int k = 0; k < directions; ++k) {
    const double z = 1 - (2 * k + 1.0) / directions, r = std::sqrt(1 - z * z);
    normals[k] = {r * std::cos(turn * k), r * std::sin(turn * k), z};
  }
  parallel_for(normals.size(), [&](std::size_t k) {
    for (const Vector<3>& v : piece.vertices) reach[k] = std::max(reach[k], normals[k].dot(v - middle));
  });
  if (!(std::ranges::min(reach) > 1e-6 * bounds.diagonal())) return std::numeric_limits<double>::infinity();
  for (int k = 0; k < directions; ++k) normals[k] /= reach[k];
  // A face of the hull of the poles of planes is a corner of what is between the planes.
  const std::optional<Mesh> poles = convex_hull_of(normals);
  if (!poles) return std::numeric_limits<double>::infinity();
  for (const FaceCorners& t : poles->triangles) {
    const Vector<3>&a = poles->vertices[t[0]], &b = poles->vertices[t[1]], &c = poles->vertices[t[2]];
    const Vector<3> normal = (b - a).cross(c - a);
    corners.push_back(normal / normal.dot(a));
  }
  const std::optional<Mesh> around = convex_hull_of(corners);
  return around ? std::abs(signed_volume(*around)) : std::numeric_limits<double>::infinity();
}

/// A solid with its pieces oriented outwards, and their sides.
class Sides {
 public:
  Sides(const Mesh& mesh, double tolerance, double widest)
      : mesh_(mesh),
        topology_(topology_of(mesh_)),
        pieces_(mesh_),
        tree_(mesh_),
        tolerance_(tolerance),
        widest_(widest),
        diagonal_(bounds_of(mesh).diagonal()) {
    faces_.resize(pieces_.count());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) faces_[pieces_.piece_of(t)].push_back(t);
    is_two_sided_ = orient_consistently(mesh_, topology_) != no_index;
    const Vector<3> center = bounds_of(mesh_).center();
    for (const std::vector<std::uint32_t>& piece : faces_) {
      double six_volumes = 0;
      for (const std::uint32_t t : piece)
        six_volumes += six_signed_volumes(mesh_, mesh_.triangles[t], center);
      if (six_volumes < 0)
        for (const std::uint32_t t : piece) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
    }
    topology_ = topology_of(mesh_);
  }

  std::vector<Hollow> hollows(double least) const {
    std::vector<Hollow> all;
    if (!is_two_sided_) return all;
    for (std::uint32_t piece = 0; piece < pieces_.count(); ++piece) {
      if (pieces_.depth(piece) > 0) continue;
      for (Hollow& hollow : hollows_of_piece(piece, least)) all.push_back(std::move(hollow));
    }
    std::ranges::stable_sort(all, std::greater<>(), &Hollow::weight);
    for (Hollow& hollow : all) add_what_stands_in(hollow);
    return all;
  }

 private:
  static constexpr std::uint32_t looks_out = no_index - 1;
  /// Up to this share of a diagonal there is only a crevice between a face and the hull.
  static constexpr double even = 1e-3;

  /// Distance from a face along a unit vector to the solid, at most the limit.
  double free_distance(const Vector<3>& from, const Vector<3>& direction, double limit) const {
    const double close = 1e-9 * diagonal_;
    return tree_.first_contact(from + 4 * close * direction, close, direction, limit, close);
  }

  /// Uses the smallest sufficient reach.
  std::vector<Hollow> hollows_of_piece(std::uint32_t piece, double least) const {
    const double own = pieces_.volumes()[piece];
    if (least > 0 && volume_around(mesh_, faces_[piece]) - own < least * own) return {};
    const std::optional<Mesh> hull = hull_of_faces(mesh_, faces_[piece]);
    if (!hull) return {};
    const TriangleTree tree(*hull);
    const double diagonal = bounds_of(*hull).diagonal(), air = std::abs(signed_volume(*hull)) - own;
    if (air < least * own) return {};
    std::vector<std::vector<Hollow>> found;  // by reach, the heaviest first
    double largest = 0, least_folded = 1;
    constexpr double least_reach = 1e-6, farthest = 0.4, hardly = 0.05;
    for (double reach = std::max(16 * tolerance_, least_reach * diagonal); reach < farthest * diagonal;
         reach *= reach < even * diagonal ? 8 : 1.6) {
      for (const bool sees_solid : {false, true}) {
        if (sees_solid && !(reach > even * diagonal_)) continue;
        std::vector<Hollow> some = hollows_within(piece, tree, reach, sees_solid);
        if (some.empty()) continue;
        std::ranges::stable_sort(some, std::greater<>(), &Hollow::weight);
        largest = std::max(largest, some.front().volume);
        found.push_back(std::move(some));
      }
      // No other hollow is as large.
      if (!found.empty() && found.back().front().volume > air / 2 && found.back().front().folded < hardly)
        break;
    }
    std::erase_if(found, [&](const auto& some) { return some.front().volume < largest / 4; });
    for (const auto& some : found) least_folded = std::min(least_folded, some.front().folded);
    for (auto& some : found)
      if (some.front().folded <= least_folded + hardly) return std::move(some);
    return {};
  }

  /// `sees_solid`: a face looks out only if the solid itself is not in its way within the reach either.
  std::vector<Hollow> hollows_within(std::uint32_t piece, const TriangleTree& hull, double reach,
                                     bool sees_solid) const {
    const std::vector<std::uint32_t>& own = faces_[piece];
    std::vector<std::uint32_t> side(mesh_.triangles.size(), looks_out);
    parallel_ranges(own.size(), 256, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) {
        const FaceCorners& face = mesh_.triangles[own[k]];
        const Vector<3> normal = doubled_area(mesh_, face).stableNormalized(), from = middle_of(mesh_, face);
        const bool leaves = hull.crossing(from + reach * normal, 0, endless) == Crossing::even;
        if (!leaves || (sees_solid && free_distance(from, normal, reach) < reach)) side[own[k]] = no_index;
      }
    });
    double own_area = 0;
    std::vector<std::pair<double, std::vector<FaceCorners>>> sides;
    for (const std::uint32_t t : own) {
      own_area += doubled_area(mesh_, mesh_.triangles[t]).norm() / 2;
      if (side[t] != no_index) continue;
      std::vector<FaceCorners> faces = faces_of_side(t, side);
      const double area = area_of(mesh_, faces);
      sides.emplace_back(area, std::move(faces));
    }
    constexpr double least_area = 1e-4;
    constexpr std::size_t most_sides = 64;
    std::ranges::stable_sort(sides, std::greater<>(), [](const auto& some) { return some.first; });
    if (sides.size() > most_sides) sides.resize(most_sides);
    std::vector<Hollow> found;
    for (const auto& [area, faces] : sides)
      if (area > least_area * own_area)
        if (std::optional<Hollow> hollow = hollow_behind(faces, area)) found.push_back(std::move(*hollow));
    return found;
  }

  /// The faces connected with `from`, oriented towards what they enclose.
  std::vector<FaceCorners> faces_of_side(std::uint32_t from, std::vector<std::uint32_t>& side) const {
    std::vector<FaceCorners> faces;
    std::vector<std::uint32_t> open{from};
    side[from] = from;
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      const auto& [a, b, c] = mesh_.triangles[t];
      faces.push_back({a, c, b});
      for (const std::uint32_t next : topology_.neighbor[t])
        if (next != no_index && side[next] == no_index) {
          side[next] = from;
          open.push_back(next);
        }
    }
    return faces;
  }

  std::optional<Hollow> hollow_behind(const std::vector<FaceCorners>& faces, double area) const {
    throw_if_interrupted();
    Hollow hollow;
    hollow.walls = {mesh_.vertices, faces};
    Mesh& walls = hollow.walls;
    const std::vector<Lid> put = put_lids(walls);
    if (put.empty() || !topology_of(walls).closed()) return std::nullopt;
    for (const Lid& lid : put) hollow.lids.push_back(lid.middle);
    hollow.is_flat = std::ranges::all_of(put, &Lid::is_flat);
    const std::vector<FaceCorners> lids(walls.triangles.begin() + static_cast<std::ptrdiff_t>(faces.size()),
                                        walls.triangles.end());
    hollow.openness = area_of(walls, lids) / area;
    if (!(hollow.openness > 0 && hollow.openness < widest_)) return std::nullopt;

    if (orient_consistently(walls, topology_of(walls)) == no_index) return std::nullopt;
    const auto ahead_of = [](const FaceCorners& t, std::uint32_t v) {
      return t[(std::ranges::find(t, v) - t.begin() + 1) % 3];
    };
    const std::uint32_t corner = faces.front()[0];
    if (ahead_of(walls.triangles.front(), corner) != ahead_of(faces.front(), corner)) turn_inside_out(walls);
    hollow.volume = signed_volume(walls);  // negative if they enclose the solid
    constexpr double crevice = 1e-6;
    if (!(hollow.volume > crevice * bounds_of(mesh_).volume())) return std::nullopt;
    const bool lie_outside =
        std::ranges::all_of(put, [&](const Lid& lid) { return lies_outside(walls, lid); });
    if (!lie_outside || crosses_solid(walls, lids, put)) return std::nullopt;
    hollow.folded = folded_share(walls, faces);
    drop_unused_vertices(walls);
    return hollow;
  }

  /// Share of these faces with others of them on their back, across the solid.
  double folded_share(const Mesh& walls, const std::vector<FaceCorners>& faces) const {
    const TriangleTree tree(walls);
    constexpr std::size_t asked = 400;
    double all = 0, folded = 0;
    for (std::size_t k = 0; k < faces.size(); k += 1 + faces.size() / asked) {
      const Vector<3> inward = doubled_area(mesh_, faces[k]);  // oriented as in `walls`, into the solid
      const Vector<3> direction = inward.stableNormalized();
      const Vector<3> from = middle_of(mesh_, faces[k]);
      const double ahead = free_distance(from, direction, diagonal_), close = 1e-8 * diagonal_;
      all += inward.norm();
      if (ahead < diagonal_ && tree.distance(from + ahead * direction, close) < close)
        folded += inward.norm();
    }
    return folded / all;
  }

  /// Tested at the middle of its largest face.
  bool lies_outside(const Mesh& walls, const Lid& lid) const {
    const auto first = walls.triangles.begin();
    const FaceCorners& largest = *std::max_element(
        first + std::ptrdiff_t(lid.first), first + std::ptrdiff_t(lid.last),
        [&](const FaceCorners& s, const FaceCorners& t) {
          return doubled_area(walls, s).squaredNorm() < doubled_area(walls, t).squaredNorm();
        });
    return tree_.crossing(middle_of(walls, largest), 0, endless) == Crossing::even;
  }

  bool crosses_solid(const Mesh& walls, const std::vector<FaceCorners>& lids,
                     const std::vector<Lid>& put) const {
    Mesh near{walls.vertices, {}};  // lids share corners with the solid by number
    for (const FaceCorners& t : mesh_.triangles) {
      const Bounds<3> own = bounds_of(mesh_, t);
      if (std::ranges::any_of(put, [&](const Lid& lid) { return lid.bounds.meets(own); }))
        near.triangles.push_back(t);
    }
    const std::size_t faces = near.triangles.size();
    near.triangles.insert(near.triangles.end(), lids.begin(), lids.end());
    return std::ranges::any_of(self_intersecting_pairs(near),
                               [&](const auto& pair) { return pair[1] >= faces; });
  }

  void add_what_stands_in(Hollow& hollow) const {
    const TriangleTree walls(hollow.walls);
    Mesh inside{mesh_.vertices, {}};
    for (std::uint32_t piece = 0; piece < pieces_.count(); ++piece)
      if (pieces_.depth(piece) == 0 && walls.crossing(pieces_.corner(piece), 0, endless) == Crossing::odd)
        for (const std::uint32_t t : faces_[piece]) inside.triangles.push_back(mesh_.triangles[t]);
    if (inside.triangles.empty()) return;
    hollow.volume -= std::abs(signed_volume(inside));
    append(hollow.walls, inside);
    drop_unused_vertices(hollow.walls);
  }

  Mesh mesh_;
  MeshTopology topology_;
  SurfacePieces pieces_;
  TriangleTree tree_;
  double tolerance_, widest_, diagonal_;
  std::vector<std::vector<std::uint32_t>> faces_;  ///< of each piece
  bool is_two_sided_ = true;
};

}  // namespace

std::vector<Hollow> hollows_of(const Mesh& solid, double tolerance, double least, double widest) {
  return Sides(solid, tolerance, widest).hollows(least);
}

std::optional<Hollow> hollow_of_shell(const Mesh& solid, double tolerance) {
  constexpr double as_much = 1, as_wide_as_a_dish = 0.8, much_more = 3, as_wide_as_a_ring = 2.5;
  const double wall = std::abs(signed_volume(solid));
  for (Hollow& hollow : hollows_of(solid, tolerance, as_much, as_wide_as_a_ring))
    if (hollow.volume >= (hollow.openness <= as_wide_as_a_dish ? as_much : much_more) * wall)
      return std::move(hollow);
  return std::nullopt;
}

}  // namespace bernal::cad
