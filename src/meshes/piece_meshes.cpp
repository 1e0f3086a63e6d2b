// Triangles of spheres outside of their circles, of necks between them, and of flat faces inside them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/hold_volume.hpp"
#include "meshes/planar_part.hpp"

namespace bernal {
namespace {

/// Of the radius: surfaces that are nearer limit by how much facets that hold the volume stand off a sphere.
/// With long edges it is their square, a fifth of which is more than they ask for.
constexpr double reach_of_room = 0.15;

double distance_to_circle(const Vector<3>& p, const Circle& circle) {
  const double along = p.dot(circle.normal) - circle.depth;
  const double beside = (p - p.dot(circle.normal) * circle.normal).norm() - circle.radius;
  return std::hypot(along, beside);
}

/// A mesh of a part with the ids of its boundary's points, and the size at those added.
struct PartMesh {
  std::vector<std::uint32_t> ids;
  PatchMesh mesh;
  std::vector<double> sizes;
};

/// Numbers of ids in a patch.
class Numbering {
 public:
  std::uint32_t operator()(std::uint32_t id) {
    const auto [entry, is_new] = number_.try_emplace(id, static_cast<std::uint32_t>(ids_.size()));
    if (is_new) ids_.push_back(id);
    return entry->second;
  }
  const std::vector<std::uint32_t>& ids() const { return ids_; }

 private:
  std::unordered_map<std::uint32_t, std::uint32_t> number_;
  std::vector<std::uint32_t> ids_;
};

void add_chain(BoundedPart& patch, Numbering& number, const std::vector<std::uint32_t>& chain,
               bool is_closed) {
  for (std::size_t k = 0; k + (is_closed ? 0 : 1) < chain.size(); ++k)
    patch.edges.push_back({number(chain[k]), number(chain[(k + 1) % chain.size()])});
}

PartMesh sphere_mesh(const SurfaceDraft& draft, const DraftPiece& part) {
  const Vector<3> center = part.piece.center;
  const double r = part.piece.radius;
  const double longest = draft.options.sphere_edge;
  const double reach = draft.options.hold_volumes ? std::max(reach_of_room, longest * longest) * r : 0;
  const std::vector<NearBall> near =
      part.is_outer() ? draft.sizes.near(center, part.piece.sphere, reach) : std::vector<NearBall>();
  const bool is_cut_at_end =
      std::ranges::any_of(part.circles, [](const Circle& c) { return c.kind == Circle::Kind::end; });
  struct Source {
    const Circle* circle;
    double edge;
  };
  std::vector<Source> sources;
  BoundedPart patch{.surface = Delaunay::Surface::sphere, .extent = r};
  Numbering number;
  for (const Circle& circle : part.circles) {
    auto& on = patch.circles.emplace_back();
    for (const auto& chain : circle.chains) {
      add_chain(patch, number, chain, circle.is_whole);
      for (const std::uint32_t id : chain) on.push_back(number(id));
    }
    if (on.empty()) patch.circles.pop_back();
    double edge = circle.edge;
    if (circle.kind != Circle::Kind::neck)
      edge =
          std::min({draft.options.sphere_edge * r, part.largest_edge, std::numbers::pi / 4 * circle.radius});
    sources.push_back({&circle, edge});
  }
  if (!part.circles.empty() && number.ids().empty()) return {};  // nothing of the sphere is left
  for (const std::uint32_t id : number.ids()) patch.points.push_back(draft.made.vertices[id] - center);
  patch.size = [&](const Vector<3>& p) {
    double size = draft.size_on(part, center + p, is_cut_at_end, near);
    for (const Source& source : sources)
      size = std::min(size, source.edge + MeshSizes::growth * distance_to_circle(p, *source.circle));
    return size;
  };
  for (const Vector<3>& corner : icosahedron()) {
    const Vector<3> p = r * corner;
    const bool is_free = std::ranges::all_of(part.circles, [&](const Circle& circle) {
      return p.dot(circle.normal) < circle.depth &&
             distance_to_circle(p, circle) > 0.5 * draft.options.sphere_edge * r;
    });
    if (is_free) patch.starts.push_back(p);
  }
  if (patch.starts.empty()) {  // a small part of a sphere: a point in its middle
    const Vector<3> p = r * (inner_point(part.piece) - center).normalized();
    if (std::ranges::all_of(part.circles,
                            [&](const Circle& circle) { return p.dot(circle.normal) < circle.depth; }))
      patch.starts.push_back(p);
  }
  PartMesh made{number.ids(), mesh_patch(patch), {}};
  for (const Vector<3>& p : made.mesh.added) made.sizes.push_back(patch.size(p));
  if (draft.options.hold_volumes)
    hold_volume(patch.points, made.mesh, r, [&](const Vector<3>& p) {
      double room = std::min({reach, draft.sizes.from_walls(center + p), draft.sizes.from_ends(center + p)});
      for (const NearBall& ball : near)
        room = std::min(room, (center + p - ball.center).norm() - ball.radius);
      return room;
    });
  for (Vector<3>& p : made.mesh.added) p += center;
  return made;
}

void append(SurfaceDraft& draft, const PartMesh& part, std::uint32_t patch, bool turned = false) {
  std::vector<std::uint32_t> id = part.ids;
  for (std::size_t k = 0; k < part.mesh.added.size(); ++k)
    id.push_back(draft.add_vertex(part.mesh.added[k], part.sizes[k]));
  for (const FaceCorners& t : part.mesh.triangles)
    draft.add_triangle(patch, id[t[0]], id[t[turned ? 2 : 1]], id[t[turned ? 1 : 2]]);
}

}  // namespace

SurfacePatch patch_of(const SurfaceDraft& draft, std::uint32_t p) {
  const DraftPiece& part = draft.pieces[p];
  return {.kind = part.is_outer() ? SurfacePatch::Kind::sphere : SurfacePatch::Kind::layer,
          .index = part.piece.sphere,
          .regions = {draft.region_of_piece(p), part.is_outer() ? 0 : draft.region_of_piece(part.around)},
          .shape = {
              .kind = RoundSurface::Kind::sphere, .center = part.piece.center, .radius = part.piece.radius}};
}

void mesh_pieces(SurfaceDraft& draft, const Monitor& monitor) {
  const Interruptible interruptible(monitor);
  constexpr std::size_t at_once = 4096;
  for (std::size_t from = 0; from < draft.pieces.size(); from += at_once) {
    const std::size_t n = std::min(at_once, draft.pieces.size() - from);
    std::vector<PartMesh> parts(n);
    parallel_ranges(n, 8, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k)
        if (const DraftPiece& part = draft.pieces[from + k]; !part.is_copied)
          parts[k] = sphere_mesh(draft, part);
    });
    for (std::size_t k = 0; k < n; ++k) {
      const auto p = static_cast<std::uint32_t>(from + k);
      if (draft.pieces[p].is_copied) continue;
      const std::uint32_t patch = draft.add_patch(patch_of(draft, p));
      append(draft, parts[k], patch);
      parts[k] = {};
    }
    monitor.report(
        {"mesh", static_cast<double>(from + n) / static_cast<double>(draft.pieces.size()), "spheres"});
  }
}

namespace {

/// Triangles between two whole circles, row by row.
void mesh_whole_neck(SurfaceDraft& draft, const DraftNeck& neck, std::uint32_t patch) {
  const std::size_t count = neck.count;
  std::vector<std::uint32_t> before = neck.rim_points[0];
  for (std::size_t row = 1; row <= neck.rows; ++row) {
    std::vector<std::uint32_t> next = neck.rim_points[1];
    if (row < neck.rows)
      for (std::size_t k = 0; k < count; ++k) {
        // Along the line of the neck's side that is half an edge on in each row.
        const double share = static_cast<double>(row) / static_cast<double>(neck.rows);
        const double half = std::numbers::pi / static_cast<double>(count);
        const double t = 2 * half * static_cast<double>(k) + half * static_cast<double>(row);
        next[k] = draft.add_vertex(point_on_side(draft, neck, share, t), neck.edge);
      }
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t l = (k + 1) % count;
      draft.add_triangle(patch, before[k], before[l], next[k]);
      draft.add_triangle(patch, before[l], next[l], next[k]);
    }
    before = next;
  }
}

/// The middle of the widest range of angles that no arc has, if there is one. An arc: where it begins and how
/// far it goes, up to pi either way.
std::optional<double> angle_without(std::vector<std::array<double, 2>> arcs) {
  constexpr double turn = 2 * std::numbers::pi;
  constexpr double least_range = 1e-3;
  for (auto& [from, length] : arcs) {
    if (length < 0) from += length;
    length = std::abs(length);
    from -= turn * std::floor(from / turn);
  }
  std::ranges::sort(arcs);
  double reached = 0, widest = least_range;
  for (const auto& [from, length] : arcs) reached = std::max(reached, from + length - turn);
  arcs.push_back({arcs.front()[0] + turn, 0});
  std::optional<double> found;
  for (const auto& [from, length] : arcs) {
    if (from - reached > widest && reached > 0) {
      widest = from - reached;
      found = 0.5 * (from + reached);
    }
    reached = std::max(reached, from + length);
  }
  return found;
}

/// Triangles of what is left of a neck's side in the domain, which is unrolled where that does not go all the
/// way around, so that edges of its boundary are as straight in the plane as they are. Else it is mapped by
/// angle and the exponential of the height, which keeps angles. In this map edges of a circle are chords,
/// which may cross what is near it on a thin neck: then heights are stretched until they do not.
void mesh_cut_neck(SurfaceDraft& draft, const DraftNeck& neck, std::uint32_t patch) {
  const double a = neck.radius, middle = 0.5 * (neck.begin + neck.end);
  const Vector<3> around = neck.around();
  std::vector<std::pair<std::vector<std::uint32_t>, bool>> chains;
  for (std::size_t e = 0; e < 2; ++e) {
    if (neck.pieces[e] == Delaunay::none) continue;
    const Circle& circle = draft.pieces[neck.pieces[e]].circles[neck.circles[e]];
    for (const auto& chain : circle.chains) chains.emplace_back(chain, circle.is_whole);
  }
  for (const NeckTrace& trace : neck.traces) chains.emplace_back(trace.ids, trace.is_closed);
  if (chains.empty()) return;

  const auto angle_of = [&](const Vector<3>& p) {
    return std::atan2((p - neck.center).dot(around), (p - neck.center).dot(neck.across));
  };
  const auto height_of = [&](const Vector<3>& p) { return (p - neck.center).dot(neck.axis) - middle; };
  const auto at = [&](double height, double angle) {
    return Vector<3>(neck.center + (middle + height) * neck.axis +
                     a * (std::cos(angle) * neck.across + std::sin(angle) * around));
  };
  std::vector<std::array<double, 2>> arcs;
  for (const auto& [chain, is_closed] : chains)
    for (std::size_t k = 0; k + (is_closed ? 0 : 1) < chain.size(); ++k) {
      const double from = angle_of(draft.made.vertices[chain[k]]);
      const double to = angle_of(draft.made.vertices[chain[(k + 1) % chain.size()]]);
      arcs.push_back({from, std::remainder(to - from, 2 * std::numbers::pi)});
    }
  const std::optional<double> cut = angle_without(std::move(arcs));
  double stretch = 1;
  const auto flat = [&](const Vector<3>& p) {
    if (!cut) {
      const double r = a * std::exp(stretch * height_of(p) / a);
      return Vector<3>(r * std::cos(angle_of(p)), r * std::sin(angle_of(p)), 0);
    }
    const double turned = std::remainder(angle_of(p) - *cut - std::numbers::pi, 2 * std::numbers::pi);
    return Vector<3>(height_of(p), a * turned, 0);
  };
  const auto back = [&](const Vector<3>& p) {
    return cut ? at(p[0], p[1] / a + *cut + std::numbers::pi)
               : at(a * std::log(p.norm() / a) / stretch, std::atan2(p[1], p[0]));
  };
  constexpr double most_stretch = 64;
  for (;; stretch *= 2) try {
      PlanarPart part(draft, flat, back);
      for (const auto& [chain, is_closed] : chains) part.add_chain(chain, is_closed);
      part.mesh(patch, true, [&](const Vector<3>&) { return neck.edge; });
      return;
    } catch (const Error&) {
      if (cut || stretch >= most_stretch) throw;
    }
}

}  // namespace

void mesh_necks(SurfaceDraft& draft) {
  for (std::uint32_t n = 0; n < draft.necks.size(); ++n) {
    const DraftNeck neck = draft.necks[n];
    const std::uint32_t patch = draft.add_patch({.kind = SurfacePatch::Kind::neck,
                                                 .index = neck.bond,
                                                 .regions = {draft.region_of_neck(n), 0},
                                                 .shape = shape_of_side(draft, neck)});
    if (neck.is_cut) {
      mesh_cut_neck(draft, neck, patch);
    } else {
      mesh_whole_neck(draft, neck, patch);
    }
  }
}

}  // namespace bernal
