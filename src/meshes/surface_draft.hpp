#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "meshes/conforming_surface.hpp"
#include "meshes/flat_walls.hpp"
#include "meshes/mesh_sizes.hpp"
#include "meshes/neck_shape.hpp"
#include "meshes/patch_mesh.hpp"

namespace bernal {

/// A plane that cuts a piece, the circle in it, and the points on that.
struct Circle {
  enum class Kind { neck, end, contact };
  Kind kind = Kind::neck;
  int face = Cut::contact;                ///< of ends: Cut::face
  std::uint32_t neck = 0;                 ///< of necks
  Vector<3> normal = Vector<3>::UnitZ();  ///< out of what is left of the ball
  double depth = 0;                       ///< from the centre along the normal
  double radius = 0;
  double edge = 0;  ///< of necks: length of its edges
  /// Parts outside of the other circles of the piece, counterclockwise about the normal; a whole circle does
  /// not repeat its first point.
  std::vector<std::vector<std::uint32_t>> chains = {};
  std::vector<std::array<std::size_t, 2>> ended_by = {};  ///< of each chain: the circles where it ends
  std::vector<std::size_t> chains_around = {};  ///< of a copied piece: which ones of the piece around it
  bool is_whole = false;
};

/// Where the planes of two circles of a piece cross inside of it.
struct Chord {
  std::array<std::size_t, 2> circles;
  std::vector<std::uint32_t> ids;
};

/// A piece of a sphere, or of the sphere within it in which one of its layers begins.
struct DraftPiece {
  static constexpr std::uint32_t none = 0xFFFFFFFF;
  Piece piece;
  std::vector<Circle> circles = {};
  std::vector<Chord> chords = {};
  std::uint32_t layer = 0;                     ///< what is behind it, from the centre out
  std::uint32_t below = 0;                     ///< so many layers below the surface
  std::uint32_t around = none, within = none;  ///< the next piece outwards and inwards, with its centre
  /// Its triangles are those of the piece around it, brought inwards, with prisms between.
  bool is_copied = false;
  double largest_edge = std::numeric_limits<double>::infinity();  ///< that its layers ask for

  bool is_outer() const { return around == none; }
};

/// Where the side of a neck meets an end of a period.
struct NeckTrace {
  int face = 0;  ///< Cut::face
  std::vector<std::uint32_t> ids = {};
  bool is_closed = false;  ///< does not repeat its first point
};

/// A neck from a sphere to another, or to a wall; what of it is in the domain, in one of its images. Heights
/// of its shape are those above `center` along `axis`. At a round wall they are scaled by 1 - rise / (end -
/// begin), with that of the wall above its tangent plane there, so that a fillet touches it everywhere.
struct DraftNeck : NeckShape {
  /// That it begins and ends at, absent where these do not reach into the domain; the second only between
  /// spheres.
  std::array<std::uint32_t, 2> pieces = {Delaunay::none, Delaunay::none};
  std::array<std::size_t, 2> circles = {};  ///< its own among those of the pieces
  std::array<std::uint32_t, 2> spheres = {};
  std::optional<std::uint32_t> wall = {};
  std::uint32_t bond = 0;                                            ///< the same for images of one neck
  std::array<int, 3> image = {};                                     ///< of the first sphere, in periods
  bool is_cut = false;                                               ///< at an end of a period
  Vector<3> center = Vector<3>::Zero();                              ///< of the first sphere
  Vector<3> axis = Vector<3>::UnitZ(), across = Vector<3>::UnitX();  ///< unit, perpendicular
  double distance = 0;    ///< of the centres, or of the centre from the wall
  double edge = 0;        ///< of its circles
  std::size_t count = 0;  ///< points of a circle, if not cut
  std::size_t rows = 1;   ///< of triangles from circle to circle, if not cut
  /// Both run alike, the second turned by half an edge a row.
  std::array<std::vector<std::uint32_t>, 2> rim_points = {};
  std::vector<NeckTrace> traces = {};
  /// Between the spheres, in closed form, of all its images together.
  double volume = 0;

  Vector<3> around() const { return axis.cross(across); }
};

/// A surface in the making.
struct SurfaceDraft {
  SurfaceDraft(const Solids& given, const SurfaceMeshOptions& asked)
      : solids(given), options(asked), boundary(boundary_of<3>(given.domain)), sizes(given, asked) {
    for (const Piece& piece : solids.pieces) add_piece({piece});
  }

  const Solids& solids;
  const SurfaceMeshOptions& options;
  Boundary<3> boundary;  ///< the ends of periods
  MeshSizes sizes;
  std::optional<PlanarWalls> flat_walls = {};  ///< of a mesh
  std::vector<DraftPiece> pieces = {};
  std::vector<DraftNeck> necks = {};
  ConformingSurface made = {};
  /// What caps that are deeper than the gap asks for add to the fluid, and to flat faces.
  struct Deepened {
    double volume = 0, area = 0;
  } deepened = {};

  /// The piece that is an image of a sphere; `Delaunay::none` where that does not reach into the domain.
  /// `below`: so many layers below the surface.
  std::uint32_t piece_at(std::uint32_t sphere, const std::array<int, 3>& image,
                         std::uint32_t below = 0) const {
    const auto found = numbers_.find({sphere, image, below});
    return found == numbers_.end() ? Delaunay::none : found->second;
  }
  std::uint32_t add_piece(DraftPiece piece) {
    const auto number = static_cast<std::uint32_t>(pieces.size());
    numbers_[{piece.piece.sphere, piece.piece.image, piece.below}] = number;
    pieces.push_back(std::move(piece));
    return number;
  }
  std::uint32_t add_vertex(const Vector<3>& p, double size) {
    made.vertices.push_back(p);
    made.size.push_back(size);
    return static_cast<std::uint32_t>(made.vertices.size() - 1);
  }
  /// The vertex at a place on the end of a period, one for equal coordinates.
  std::uint32_t vertex_at(const Vector<3>& p, double size) {
    const auto [entry, is_new] = at_.try_emplace({p[0], p[1], p[2]}, 0);
    if (is_new) entry->second = add_vertex(p, size);
    return entry->second;
  }
  /// The vertex at the upper end of an axis that belongs to one at the lower.
  std::uint32_t lifted(int axis, std::uint32_t lower) {
    const auto [entry, is_new] = lifted_[static_cast<std::size_t>(axis)].try_emplace(lower, 0);
    if (is_new) {
      Vector<3> p = made.vertices[lower];
      p[axis] = boundary.origin[axis] + boundary.edges[axis];
      entry->second = vertex_at(p, made.size[lower]);
      made.periodic[static_cast<std::size_t>(axis)].push_back({lower, entry->second});
    }
    return entry->second;
  }
  /// Whether what is at this end is copied from the opposite end of a period.
  bool is_lifted(int face) const { return face % 2 == 1 && !solids.is_cut(); }
  double end_at(int face) const {
    return boundary.origin[face / 2] + (face % 2 == 1 ? boundary.edges[face / 2] : 0.0);
  }
  /// Gives a point that lies on an end of a period, or a face of a part that is cut out, to rounding the
  /// coordinate that all points there have exactly, if any.
  void put_on_end(int face, Vector<3>& p) const {
    if (solids.part) {
      solids.part->put_on(static_cast<std::uint32_t>(face), p);
    } else {
      p[face / 2] = end_at(face);
    }
  }
  SurfacePatch::Kind kind_of_ends() const {
    return solids.is_cut() ? SurfacePatch::Kind::wall : SurfacePatch::Kind::period_end;
  }
  std::uint32_t add_patch(const SurfacePatch& patch) {
    made.patches.push_back(patch);
    return static_cast<std::uint32_t>(made.patches.size() - 1);
  }
  void add_triangle(std::uint32_t patch, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    made.triangles.push_back({a, b, c});
    made.patch.push_back(patch);
  }
  /// What is between a piece and the one within it.
  std::int32_t region_of_piece(std::uint32_t piece) const {
    return options.solids ? static_cast<std::int32_t>(1 + piece) : SurfacePatch::nothing;
  }
  /// As `per_gap`, between spheres in which layers begin and ends that pass by: both sides are fixed there.
  double per_gap_of_layers() const { return std::min(options.per_gap, 2.0); }
  /// The length of edges on a piece at a point, in the scene.
  double size_on(const DraftPiece& of, const Vector<3>& p, bool is_cut_at_end,
                 const std::vector<NearBall>& near) const {
    const double r = of.piece.radius;
    if (of.is_outer())
      return std::min(of.largest_edge, sizes.on_sphere(p, of.piece.center, r, is_cut_at_end, near));
    const double size = std::min(of.largest_edge, options.sphere_edge * r);
    return is_cut_at_end ? size
                         : std::max(std::min(size, per_gap_of_layers() * sizes.from_ends(p)), 1e-4 * r);
  }
  std::int32_t region_of_neck(std::uint32_t neck) const {
    return options.solids ? static_cast<std::int32_t>(1 + pieces.size() + neck) : SurfacePatch::nothing;
  }

 private:
  std::map<std::tuple<std::uint32_t, std::array<int, 3>, std::uint32_t>, std::uint32_t> numbers_;
  std::map<std::array<double, 3>, std::uint32_t> at_;
  std::array<std::unordered_map<std::uint32_t, std::uint32_t>, 3> lifted_;
};

/// Cuts caps off deeper whose circles an end of a period would nearly touch or cut at a small angle.
void deepen_caps(SurfaceDraft&);
/// Finds the necks between spheres and to walls, makes them narrower where others would meet them, and
/// narrower or wider where ends of periods would nearly touch them, and puts their circles on the pieces and,
/// where no end cuts them, points on these.
void add_necks(SurfaceDraft&);
/// Adds the spheres within spheres in which their layers begin, after `add_necks`. Throws where a neck or a
/// cap reaches through a layer.
void add_shells(SurfaceDraft&);
/// Triangles of spheres that are copied from those around them, with prisms between, after `mesh_flat_faces`.
void mesh_copied_shells(SurfaceDraft&);
/// The points of all other circles; those at opposite ends are the same but for the period.
void add_circles(SurfaceDraft&);
/// Where necks meet ends of periods, with the same points at opposite ends. After their circles.
void add_neck_traces(SurfaceDraft&);
/// How clearly the ends of periods cut or miss a circle on a sphere, given by the direction of its centre and
/// its radius: 1 or more where it makes triangles of edges of this length without small angles.
double clearance_of_ends(const Boundary<3>&, const Vector<3>& center, double sphere_radius,
                         const Vector<3>& direction, double radius, double edge);
/// The point of a neck's wall that stands over a point of its section, given from its axis.
Vector<3> foot_of(const SurfaceDraft&, const DraftNeck&, const Vector<3>& beside);
/// The point of a neck's side at this share of its meridian.
Vector<3> point_on_side(const SurfaceDraft&, const DraftNeck&, double share, double angle);
/// What the side of a neck is.
RoundSurface shape_of_side(const SurfaceDraft&, const DraftNeck&);
/// Triangles of the sides of necks.
void mesh_necks(SurfaceDraft&);
/// The patch of a piece's sphere.
SurfacePatch patch_of(const SurfaceDraft&, std::uint32_t piece);
/// Triangles of the spheres.
void mesh_pieces(SurfaceDraft&, const Monitor&);
/// Triangles of flat faces of caps and, with solids, of spheres at the ends of periods and of necks' ends.
void mesh_flat_faces(SurfaceDraft&);
/// What a wall is, by its number as in SurfacePatch.
RoundSurface shape_of_wall(const Domain&, std::uint32_t wall);
/// Triangles of the walls and ends of periods.
void mesh_box(SurfaceDraft&, const Box&);
void mesh_cylinder(SurfaceDraft&, const Cylinder&);
void mesh_ball(SurfaceDraft&, const Sphere&);
void mesh_flat_walls(SurfaceDraft&, const Mesh&);
void mesh_cut_faces(SurfaceDraft&, const ConvexPart&);
/// A point inside a piece and not near its cuts.
Vector<3> inner_point(const Piece&);
/// Regions with points inside.
void add_regions(SurfaceDraft&);
/// Angles, edges and volumes.
void state(SurfaceDraft&);

}  // namespace bernal
