// Walls that are triangles: the edges between their smooth parts first, then these.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "core/parallel.hpp"
#include "meshes/flat_wall_edges.hpp"
#include "meshes/planar_part.hpp"

namespace bernal {
namespace {

/// Of the smallest radius: how far triangles across facets may be off these.
constexpr double deviation_of_radius = 0.02;
/// With ever shorter edges, before facets are kept.
constexpr int most_attempts = 8;

class FacetedWalls {
 public:
  FacetedWalls(SurfaceDraft& draft, const Mesh& mesh)
      : draft_(draft),
        mesh_(mesh),
        flat_(*draft.flat_walls),
        tolerance_(deviation_of_radius * draft.sizes.least_radius()),
        of_flat_part_(flat_.parts.size()),
        keep_apart_(flat_.parts.size(), 0),
        limits_(flat_.parts.size(), std::numeric_limits<double>::infinity()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      of_flat_part_[flat_.part_of_triangle[t]].push_back(t);
  }

  /// With all facets that may be joined; again with shorter edges or less of them where that is not sound.
  void mesh() {
    const ConformingSurface& made = draft_.made;
    const std::size_t vertices = made.vertices.size(), triangles = made.triangles.size(),
                      patches = made.patches.size();
    while (!try_to_mesh()) {
      draft_.made.vertices.resize(vertices);
      draft_.made.size.resize(vertices);
      draft_.made.triangles.resize(triangles);
      draft_.made.patch.resize(triangles);
      draft_.made.patches.resize(patches);
    }
  }

 private:
  bool try_to_mesh() {
    walls_ = smooth_walls_of(mesh_, flat_, tolerance_, keep_apart_);
    for (std::size_t p = 0; p < limits_.size(); ++p)
      walls_.longest[p] = std::min(walls_.longest[p], limits_[p]);
    first_.clear();
    deviation_ = 0;
    ++attempts_;
    const auto chains = points_on_flat_edges(draft_, walls_, mesh_);
    std::vector<std::vector<std::uint32_t>> edges(walls_.parts.size()), feet(walls_.parts.size());
    for (std::uint32_t e = 0; e < walls_.edges.size(); ++e)
      for (const std::uint32_t part : walls_.edges[e].parts) edges[part].push_back(e);
    for (std::uint32_t n = 0; n < draft_.necks.size(); ++n)
      if (draft_.necks[n].wall) feet[walls_.of_flat_part[*draft_.necks[n].wall]].push_back(n);
    bool is_sound = true, is_joined = false;
    for (std::uint32_t p = 0; p < walls_.parts.size(); ++p) {
      first_.push_back(draft_.made.triangles.size());
      if (edges[p].empty()) continue;  // without height: within another part
      const auto add_boundary = [&](PlanarPart& part) {
        for (const std::uint32_t e : edges[p]) part.add_chain(chains[e], false);
        for (const std::uint32_t n : feet[p]) part.add_chain(draft_.necks[n].rim_points[1], true);
      };
      if (walls_.parts[p].is_planar()) {
        mesh_planar(walls_.parts[p], add_boundary);
      } else {
        is_joined = true;
        is_sound = mesh_joined(p, add_boundary) && is_sound;
      }
    }
    first_.push_back(draft_.made.triangles.size());
    if (is_joined && is_sound) is_sound = is_clear_of_spheres() && crosses_nothing();
    draft_.made.statement.wall_deviation = deviation_;
    return is_sound;
  }

  std::uint32_t add_patch(const SmoothPart& part) {
    return draft_.add_patch({SurfacePatch::Kind::wall, part.parts.front(), {0, SurfacePatch::nothing}});
  }

  template <class AddBoundary>
  void mesh_planar(const SmoothPart& of, const AddBoundary& add_boundary) {
    const FlatPart& frame = of.frame;
    PlanarPart part(
        draft_,
        [&](const Vector<3>& q) {
          return Vector<3>((q - frame.origin).dot(frame.u), (q - frame.origin).dot(frame.v), 0);
        },
        [&](const Vector<3>& q) { return Vector<3>(frame.origin + q[0] * frame.u + q[1] * frame.v); });
    add_boundary(part);
    part.mesh(add_patch(of), false,
              [&](const Vector<3>& q) { return draft_.sizes.on_wall(q, frame.outward, false); });
  }

  template <class AddBoundary>
  bool mesh_joined(std::uint32_t p, const AddBoundary& add_boundary) {
    const SmoothPart& of = walls_.parts[p];
    const SmoothSurface surface(mesh_, of, of_flat_part_);
    PlanarPart part(
        draft_, [&](const Vector<3>& q) { return surface.flat(q); },
        [&](const Vector<3>& q) { return surface.over(q).point; });
    add_boundary(part);
    try {
      part.mesh(add_patch(of), false, [&](const Vector<3>& q) {
        const std::uint32_t at = surface.over(surface.flat(q)).flat_part;
        const Vector<3>& outward = flat_.parts[at].outward;
        // Lengths are those seen along the frame's direction.
        return outward.dot(of.frame.outward) *
               std::min(walls_.longest[at], draft_.sizes.on_wall(q, outward, false));
      });
    } catch (const Error&) {
      return refuse(p);
    }
    return stays_near(p, surface, part.triangles());
  }

  /// Measures how far triangles are off the facets, in the middle and in the middles of their edges. Where
  /// that is too far, edges are shorter next time.
  bool stays_near(std::uint32_t p, const SmoothSurface& surface, const std::vector<FaceCorners>& triangles) {
    const Vector<3>& above = walls_.parts[p].frame.outward;
    bool is_near = true;
    for (const FaceCorners& t : triangles) {
      const std::array<Vector<3>, 3> c = {draft_.made.vertices[t[0]], draft_.made.vertices[t[1]],
                                          draft_.made.vertices[t[2]]};
      const double longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
      for (const Vector<3>& q : {Vector<3>(0.5 * (c[0] + c[1])), Vector<3>(0.5 * (c[1] + c[2])),
                                 Vector<3>(0.5 * (c[2] + c[0])), Vector<3>((c[0] + c[1] + c[2]) / 3)}) {
        const SmoothSurface::Place place = surface.over(surface.flat(q));
        const double off =
            std::abs(surface.height_of(q) - place.height) * flat_.parts[place.flat_part].outward.dot(above);
        deviation_ = std::max(deviation_, off);
        if (off <= tolerance_) continue;
        is_near = false;
        const double shorter = 0.9 * longest * std::sqrt(tolerance_ / off);
        limits_[place.flat_part] = std::min(limits_[place.flat_part], shorter);
        for (const Vector<3>& corner : c) {
          double& limit = limits_[surface.over(surface.flat(corner)).flat_part];
          limit = std::min(limit, shorter);
        }
      }
    }
    return is_near || (attempts_ >= most_attempts && refuse(p));
  }

  /// The facets of a part are not joined next time.
  bool refuse(std::uint32_t part) {
    for (const std::uint32_t flat : walls_.parts[part].parts) keep_apart_[flat] = 1;
    return false;
  }
  std::uint32_t part_of(std::size_t triangle) const {
    return static_cast<std::uint32_t>(std::ranges::upper_bound(first_, triangle) - first_.begin() - 1);
  }

  /// Whether at least half of each sphere's distance from the facets is left.
  bool is_clear_of_spheres() {
    std::vector<std::size_t> triangles;
    std::vector<Bounds<3>> boxes;
    for (std::size_t t = first_.front(); t < first_.back(); ++t) {
      if (walls_.parts[part_of(t)].is_planar()) continue;
      Bounds<3>& box = boxes.emplace_back(Bounds<3>::of_nothing());
      for (const std::uint32_t corner : draft_.made.triangles[t]) box.add(draft_.made.vertices[corner]);
      triangles.push_back(t);
    }
    const BoxTree<3> tree(boxes, 4);
    const Spheres<dynamic>& spheres = draft_.solids.spheres;
    bool is_clear = true;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      throw_if_interrupted();
      const Vector<3> c = spheres.center(i);
      const double r = spheres.r[i], least = r + 0.5 * std::max(0.0, draft_.sizes.from_walls(c) - r);
      tree.for_each_near(c, least, [&](std::uint32_t k) {
        const FaceCorners& t = draft_.made.triangles[triangles[k]];
        const Facet facet{.kind = Facet::Kind::triangle,
                          .a = draft_.made.vertices[t[0]],
                          .b = draft_.made.vertices[t[1]],
                          .c = draft_.made.vertices[t[2]]};
        if ((closest_point(facet, c) - c).norm() < least) is_clear = refuse(part_of(triangles[k]));
      });
    }
    return is_clear;
  }

  bool crosses_nothing() {
    Mesh walls;
    walls.vertices = draft_.made.vertices;
    walls.triangles.assign(draft_.made.triangles.begin() + static_cast<std::ptrdiff_t>(first_.front()),
                           draft_.made.triangles.end());
    bool is_sound = true;
    for (const auto& pair : cad::self_intersecting_pairs(walls))
      for (const std::uint32_t t : pair)
        if (const std::uint32_t part = part_of(first_.front() + t); !walls_.parts[part].is_planar())
          is_sound = refuse(part);
    return is_sound;
  }

  SurfaceDraft& draft_;
  const Mesh& mesh_;
  const PlanarWalls& flat_;
  double tolerance_;
  std::vector<std::vector<std::uint32_t>> of_flat_part_;  ///< triangles of the mesh
  std::vector<char> keep_apart_;
  std::vector<double> limits_;  ///< of edges on planar parts, so that they stay near the facets
  int attempts_ = 0;
  SmoothWalls walls_;
  std::vector<std::size_t> first_;  ///< triangles of each smooth part, and the end
  double deviation_ = 0;
};

}  // namespace

void mesh_flat_walls(SurfaceDraft& draft, const Mesh& mesh) { FacetedWalls(draft, mesh).mesh(); }

}  // namespace bernal
