// Walls and ends of periods, of boxes and cylinders: their edges first, then what is between them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "meshes/planar_part.hpp"

namespace bernal {
namespace {

using std::numbers::pi;

/// Adds the circles in which spheres or necks meet a wall or an end.
void add_circles_of(const SurfaceDraft& draft, std::uint32_t face, bool is_end, bool as_holes,
                    PlanarPart& part) {
  if (is_end) {
    for (const DraftPiece& piece : draft.pieces)
      for (std::size_t c = 0; c < piece.circles.size(); ++c) {
        const Circle& circle = piece.circles[c];
        if (!piece.is_outer() || circle.kind != Circle::Kind::end || circle.face != static_cast<int>(face))
          continue;
        for (const auto& chain : circle.chains) part.add_chain(chain, circle.is_whole);
        for (const Chord& chord : piece.chords) {  // where caps begin
          if (chord.circles[0] != c && chord.circles[1] != c) continue;
          const std::size_t other = chord.circles[0] == c ? chord.circles[1] : chord.circles[0];
          if (piece.circles[other].kind == Circle::Kind::contact) part.add_chain(chord.ids, false);
        }
      }
    for (const DraftNeck& neck : draft.necks)
      for (const NeckTrace& trace : neck.traces)
        if (trace.face == static_cast<int>(face)) part.add_chain(trace.ids, trace.is_closed);
    return;
  }
  for (const DraftNeck& neck : draft.necks) {
    if (neck.wall != face) continue;
    if (as_holes) {
      part.add_hole(neck.rim_points[1]);
    } else {
      part.add_chain(neck.rim_points[1], true);
    }
  }
}

bool is_in_piece(const Piece& piece, const Vector<3>& p) {
  return (p - piece.center).norm() < piece.radius && std::ranges::all_of(piece.cuts, [&](const Cut& cut) {
           return cut.face != Cut::contact || cut.keeps.normal.dot(p) < cut.keeps.offset;
         });
}

bool is_in_neck(const DraftNeck& neck, const Vector<3>& p) {
  const Vector<3> d = p - neck.center;
  const double height = d.dot(neck.axis);
  return height > neck.begin && height < neck.end && (d - height * neck.axis).norm() < neck.radius;
}

class BoxWalls {
 public:
  BoxWalls(SurfaceDraft& draft, const Box& box) : draft_(draft) {
    for (int k = 0; k < 3; ++k) {
      repeats_[k] = box.repeats(k);
      ends_[0][k] = box.corner[k];
      ends_[1][k] =
          repeats_[k] ? draft.boundary.origin[k] + draft.boundary.edges[k] : box.corner[k] + box.size[k];
    }
  }

  void mesh() {
    for (int m = 0; m < 3; ++m)
      for (int side = 0; side < 4; ++side) make_line(m, side % 2, side / 2);
    for (int k = 0; k < 3; ++k)
      for (int s = 0; s < (repeats_[k] ? 1 : 2); ++s) make_face(k, s);
  }

 private:
  bool cuts_spheres(int axis) const { return repeats_[static_cast<std::size_t>(axis)]; }
  std::vector<std::vector<std::uint32_t>>& line(int m, int a, int b) {
    return lines_[static_cast<std::size_t>(4 * m + 2 * b + a)];
  }

  /// Where spheres, caps and necks cross an edge of the box along axis m.
  struct Crossings {
    std::set<std::pair<double, std::uint32_t>> at = {};
    std::vector<const Piece*> pieces = {};  ///< that may lie on it
  };
  Crossings crossings_of(int face, int l, double level, int m) const {
    Crossings found;
    const auto add_ends = [&](const std::vector<std::uint32_t>& chain) {
      for (const std::uint32_t id : {chain.front(), chain.back()})
        if (const Vector<3>& p = draft_.made.vertices[id]; p[l] == level) found.at.insert({p[m], id});
    };
    for (const DraftNeck& neck : draft_.necks)
      for (const NeckTrace& trace : neck.traces)
        if (trace.face == face && !trace.is_closed) add_ends(trace.ids);
    for (const DraftPiece& piece : draft_.pieces)
      for (std::size_t c = 0; c < piece.circles.size(); ++c) {
        const Circle& circle = piece.circles[c];
        if (!piece.is_outer() || circle.kind != Circle::Kind::end || circle.face != face) continue;
        found.pieces.push_back(&piece.piece);
        if (!circle.is_whole)
          for (const auto& chain : circle.chains) add_ends(chain);
        for (const Chord& chord : piece.chords) {
          if (chord.circles[0] != c && chord.circles[1] != c) continue;
          const std::size_t other = chord.circles[0] == c ? chord.circles[1] : chord.circles[0];
          if (piece.circles[other].kind == Circle::Kind::contact) add_ends(chord.ids);
        }
      }
    return found;
  }

  /// The parts in the fluid of the edge along axis m, at the ends a and b of the next two axes.
  void make_line(int m, int a, int b) {
    const int k = (m + 1) % 3, l = (m + 2) % 3;
    auto& chains = line(m, a, b);
    for (const auto& [axis, side] : {std::pair(k, a), std::pair(l, b)}) {
      if (!repeats_[axis] || side == 0) continue;
      chains = axis == k ? line(m, 0, b) : line(m, a, 0);
      for (auto& chain : chains)
        for (std::uint32_t& id : chain) id = draft_.lifted(axis, id);
      return;
    }
    Vector<3> at;
    at[k] = ends_[static_cast<std::size_t>(a)][k];
    at[l] = ends_[static_cast<std::size_t>(b)][l];
    const auto point = [&](double x) {
      at[m] = x;
      return at;
    };
    const auto size = [&](double x) {
      return std::min(draft_.sizes.on_wall(point(x), Vector<3>::Unit(k), cuts_spheres(k)),
                      draft_.sizes.on_wall(point(x), Vector<3>::Unit(l), cuts_spheres(l)));
    };
    const auto crossings =
        cuts_spheres(k) && cuts_spheres(l) ? crossings_of(2 * k + a, l, at[l], m) : Crossings{};
    const double lower = ends_[0][m], upper = ends_[1][m];
    const std::uint32_t first = draft_.vertex_at(point(lower), size(lower));
    const std::uint32_t last =
        repeats_[m] ? draft_.lifted(m, first) : draft_.vertex_at(point(upper), size(upper));
    std::vector<std::pair<double, std::uint32_t>> stops = {{lower, first}};
    for (const auto& crossing : crossings.at)
      if (crossing.first > lower && crossing.first < upper) stops.push_back(crossing);
    stops.push_back({upper, last});
    for (std::size_t s = 0; s + 1 < stops.size(); ++s) {
      const double from = stops[s].first, length = stops[s + 1].first - from;
      const Vector<3> middle = point(from + 0.5 * length);
      if (std::ranges::any_of(crossings.pieces,
                              [&](const Piece* piece) { return is_in_piece(*piece, middle); }) ||
          std::ranges::any_of(draft_.necks,
                              [&](const DraftNeck& neck) { return neck.is_cut && is_in_neck(neck, middle); }))
        continue;
      auto& chain = chains.emplace_back(1, stops[s].second);
      for (const double share : spaced(length, 1, [&](double t) { return size(from + t * length); }))
        chain.push_back(draft_.vertex_at(point(from + share * length), size(from + share * length)));
      chain.push_back(stops[s + 1].second);
    }
  }

  void make_face(int k, int side) {
    const int u = (k + 1) % 3, v = (k + 2) % 3;
    const double at = ends_[static_cast<std::size_t>(side)][k];
    const Vector<3> middle = 0.5 * (ends_[0] + ends_[1]);
    PlanarPart part(
        draft_, [=](const Vector<3>& p) { return Vector<3>(p[u] - middle[u], p[v] - middle[v], 0); },
        [=](const Vector<3>& p) {
          Vector<3> q;
          q[k] = at;
          q[u] = middle[u] + p[0];
          q[v] = middle[v] + p[1];
          return q;
        });
    for (int s = 0; s < 2; ++s) {
      // line(m, a, b) is at the ends a of axis m + 1 and b of axis m + 2.
      for (const auto& chain : line(u, s, side)) part.add_chain(chain, false);
      for (const auto& chain : line(v, side, s)) part.add_chain(chain, false);
    }
    const auto face = static_cast<std::uint32_t>(2 * k + side);
    add_circles_of(draft_, face, cuts_spheres(k), false, part);
    const auto kind = repeats_[k] ? SurfacePatch::Kind::period_end : SurfacePatch::Kind::wall;
    const std::uint32_t patch = draft_.add_patch({kind, face, {0, SurfacePatch::nothing}});
    part.mesh(patch, side == 0, [&](const Vector<3>& p) {
      return draft_.sizes.on_wall(p, Vector<3>::Unit(k), cuts_spheres(k));
    });
    if (!repeats_[k]) return;
    const std::uint32_t opposite = draft_.add_patch({kind, face + 1, {0, SurfacePatch::nothing}});
    for (const FaceCorners& t : part.triangles())
      draft_.add_triangle(opposite, draft_.lifted(k, t[0]), draft_.lifted(k, t[1]), draft_.lifted(k, t[2]));
  }

  SurfaceDraft& draft_;
  std::array<bool, 3> repeats_{};
  std::array<Vector<3>, 2> ends_;
  std::array<std::vector<std::vector<std::uint32_t>>, 12> lines_;
};

}  // namespace

RoundSurface shape_of_wall(const Domain& domain, std::uint32_t wall) {
  if (const auto* sphere = std::get_if<Sphere>(&domain))
    return {.kind = RoundSurface::Kind::sphere, .center = sphere->center, .radius = sphere->radius};
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  if (cylinder == nullptr || wall != 0) return {};
  return {.kind = RoundSurface::Kind::cylinder,
          .center = cylinder->base,
          .axis = cylinder->axis.normalized(),
          .radius = cylinder->radius};
}

void mesh_box(SurfaceDraft& draft, const Box& box) { BoxWalls(draft, box).mesh(); }

void mesh_cylinder(SurfaceDraft& draft, const Cylinder& cylinder) {
  const int axis = cylinder.periodic ? cylinder.coordinate_axis() : -1;
  const Vector<3> a =
      cylinder.periodic ? Vector<3>(Vector<3>::Unit(axis)) : Vector<3>(cylinder.axis.normalized());
  const Vector<3> u = a.unitOrthogonal(), v = a.cross(u);
  Vector<3> base = cylinder.base;
  if (cylinder.periodic) base[axis] = draft.boundary.origin[axis];
  const double radius = cylinder.radius, height = cylinder.height;
  const auto on_side = [&](double angle, double z) {
    const Vector<3> p = base + radius * (std::cos(angle) * u + std::sin(angle) * v) + z * a;
    return p;
  };
  const auto side_size = [&](const Vector<3>& p) {
    const Vector<3> d = p - base;
    return draft.sizes.on_wall(p, (d - d.dot(a) * a).normalized(), false);
  };
  const auto lid_size = [&](const Vector<3>& p) { return draft.sizes.on_wall(p, a, cylinder.periodic); };
  const auto end_of = [&](bool upper) {
    return upper ? draft.boundary.origin[axis] + draft.boundary.edges[axis] : draft.boundary.origin[axis];
  };

  std::array<std::vector<std::uint32_t>, 2> rims;
  for (const int side : {0, 1}) {
    if (side == 1 && cylinder.periodic) {
      for (const std::uint32_t id : rims[0]) rims[1].push_back(draft.lifted(axis, id));
      break;
    }
    const double z = side * height;
    const auto at = [&](double share) {
      Vector<3> p = on_side(2 * pi * share, z);
      if (cylinder.periodic) p[axis] = end_of(false);
      return p;
    };
    const auto size = [&](double share) { return std::min(side_size(at(share)), lid_size(at(share))); };
    std::vector<double> shares = {0};
    for (const double share : spaced(2 * pi * radius, 12, size)) shares.push_back(share);
    for (const double share : shares)
      rims[static_cast<std::size_t>(side)].push_back(draft.vertex_at(at(share), size(share)));
  }

  PlanarPart side(
      draft,
      [&](const Vector<3>& p) {
        const Vector<3> d = p - base;
        double angle = std::atan2(d.dot(v), d.dot(u));
        if (angle < 0) angle += 2 * pi;
        double z = d.dot(a);
        if (std::abs(z) < 1e-9 * height) z = 0;
        if (std::abs(z - height) < 1e-9 * height) z = height;
        return Vector<3>(std::min(angle * radius, std::nextafter(2 * pi * radius, 0.0)), z, 0);
      },
      [&](const Vector<3>& p) { return on_side(p[0] / radius, p[1]); });
  for (const auto& rim : rims) side.add_chain(rim, true);
  add_circles_of(draft, 0, false, true, side);
  const std::uint32_t side_patch =
      draft.add_patch({SurfacePatch::Kind::wall, 0, {0, SurfacePatch::nothing}, shape_of_wall(cylinder, 0)});
  const double margin = std::min(6 * draft.options.sphere_edge * draft.sizes.largest_radius(), pi * radius);
  side.mesh(side_patch, false, side_size, 2 * pi * radius, margin);

  for (const int end : {0, 1}) {
    const auto kind = cylinder.periodic ? SurfacePatch::Kind::period_end : SurfacePatch::Kind::wall;
    const auto face = static_cast<std::uint32_t>(cylinder.periodic ? 2 * axis + end : 1 + end);
    PlanarPart lid(
        draft, [&](const Vector<3>& p) { return Vector<3>((p - base).dot(u), (p - base).dot(v), 0); },
        [&](const Vector<3>& p) {
          Vector<3> q = base + p[0] * u + p[1] * v + end * height * a;
          if (cylinder.periodic) q[axis] = end_of(false);
          return q;
        });
    lid.add_chain(rims[static_cast<std::size_t>(end)], true);
    add_circles_of(draft, face, cylinder.periodic, false, lid);
    const std::uint32_t patch = draft.add_patch({kind, face, {0, SurfacePatch::nothing}});
    lid.mesh(patch, end == 0, lid_size);
    if (!cylinder.periodic) continue;
    const std::uint32_t opposite = draft.add_patch({kind, face + 1, {0, SurfacePatch::nothing}});
    for (const FaceCorners& t : lid.triangles())
      draft.add_triangle(opposite, draft.lifted(axis, t[0]), draft.lifted(axis, t[1]),
                         draft.lifted(axis, t[2]));
    break;
  }
}

void mesh_ball(SurfaceDraft& draft, const Sphere& sphere) {
  BoundedPart patch{.surface = Delaunay::Surface::sphere, .extent = sphere.radius};
  std::vector<std::uint32_t> ids;
  for (const DraftNeck& neck : draft.necks) {
    if (!neck.wall) continue;
    auto& circle = patch.circles.emplace_back();
    for (const std::uint32_t id : neck.rim_points[1]) {
      circle.push_back(static_cast<std::uint32_t>(ids.size()));
      ids.push_back(id);
      patch.points.push_back(draft.made.vertices[id] - sphere.center);
    }
    for (std::size_t k = 0; k < circle.size(); ++k)
      patch.edges.push_back({circle[k], circle[(k + 1) % circle.size()]});
  }
  patch.size = [&](const Vector<3>& p) {
    return draft.sizes.on_wall(sphere.center + p, p.normalized(), false);
  };
  for (const Vector<3>& corner : icosahedron()) {
    const Vector<3> p = sphere.radius * corner;
    const bool is_free = std::ranges::all_of(draft.necks, [&](const DraftNeck& neck) {
      const Vector<3> foot = sphere.radius * neck.axis;
      return !neck.wall || (p - foot).norm() > 2 * neck.rims[1];
    });
    if (is_free) patch.starts.push_back(p);
  }
  const PatchMesh mesh = mesh_patch(patch);
  for (const Vector<3>& p : mesh.added) ids.push_back(draft.add_vertex(sphere.center + p, patch.size(p)));
  const std::uint32_t number =
      draft.add_patch({SurfacePatch::Kind::wall, 0, {0, SurfacePatch::nothing}, shape_of_wall(sphere, 0)});
  for (const FaceCorners& t : mesh.triangles) draft.add_triangle(number, ids[t[0]], ids[t[1]], ids[t[2]]);
}

}  // namespace bernal
