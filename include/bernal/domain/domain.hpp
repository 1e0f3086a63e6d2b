#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/geometry/mesh.hpp"

namespace bernal {

// What spheres are packed into, as plain data: walls, and periods with which everything repeats itself. A
// Container answers questions about the walls, a Boundary about the periods, and the certificate decides on
// the same data by itself. The doubles below *are* the domain: nothing else is meant by them.

/// The box [corner, corner + size] in any dimension, the sum being that of real numbers: it need not be a
/// double, and what has to stay inside takes the largest that is not above it. Every axis either ends at two
/// walls, with whole spheres between them, or repeats itself without end: there spheres have images in every
/// box, and a sphere may be its own neighbour.
struct Box {
  Coordinates corner = Vector<3>::Zero();
  Coordinates size = Vector<3>::Ones();
  std::vector<bool> periodic = {};  ///< whether each axis repeats itself; empty: none does
  Tilt tilt = {};                   ///< of one without walls, of two or three dimensions; all 0: upright

  int dimension() const { return static_cast<int>(size.size()); }
  bool repeats(int axis) const { return !periodic.empty() && periodic[static_cast<std::size_t>(axis)]; }
  bool has_wall(int axis) const { return !repeats(axis); }
  bool is_tilted() const { return tilt != Tilt{}; }
  bool repeats() const { return std::find(periodic.begin(), periodic.end(), true) != periodic.end(); }
  bool has_walls() const {
    return periodic.empty() || std::find(periodic.begin(), periodic.end(), false) != periodic.end();
  }
};

/// The box [0, edges[k]) that repeats itself along every axis but those with `walls` (empty: none has).
Box periodic_box(const Vector<dynamic>& edges, const std::vector<bool>& walls = {}, const Tilt& tilt = {});

/// The tilt of a box that has been scaled to other edges, in proportion to them; that of these very edges is
/// as it stands.
Tilt tilt_in_proportion(const Box& box, const Vector<dynamic>& edges);
/// The least distance between a point and an image of it. Precondition: the box repeats itself along every
/// axis.
double shortest_period(const Box&);

/// Points p with 0 <= (p - base)·a <= height for a = axis / |axis|, at most `radius` from the axis line.
/// `axis` need not be of unit length. A periodic one has no lids: it is an endless column that repeats itself
/// with the period `height`, and its axis lies along a coordinate axis.
struct Cylinder {
  Vector<3> base = Vector<3>::Zero();
  Vector<3> axis = Vector<3>::UnitZ();
  double radius = 1;
  double height = 1;
  bool periodic = false;

  /// The coordinate axis that the axis lies along, or -1.
  int coordinate_axis() const;
};

struct Sphere {
  Vector<3> center = Vector<3>::Zero();
  double radius = 1;
};

/// The points of the plane from which a ray crosses closed lines an odd number of times: of an outline and
/// the holes in it what is between them. Every line joins its corners in their order and the last to the
/// first, in either sense; edges without length count for nothing. See `require_simple`.
struct Polygon {
  std::vector<std::vector<Vector<2>>> loops;
  double inset = 0;  ///< as that of a mesh
};

/// Throws Error{bad_argument} that names the edges and the place, unless a polygon has finite corners, at
/// least three a line that are not in a row, and edges that meet nowhere but at the ends of neighbours.
/// Exact. Cost: O(n log n), and every pair of edges whose bounds overlap.
void require_simple(const Polygon&);

/// A solid of revolution: the points at the distance r from the axis line and the height z = (p - base)·a,
/// with a = axis / |axis|, such that (r, z) lies in the polygon whose corners the profile names in their
/// order, in either sense; the last is joined to the first. `axis` need not be of unit length. Edges on the
/// axis are no walls. The distance of a point from the wall is that of its (r, z) from the other edges. See
/// `require_profile`.
struct Revolved {
  Vector<3> base = Vector<3>::Zero();
  Vector<3> axis = Vector<3>::UnitZ();
  std::vector<Vector<2>> profile = {};
  double inset = 0;  ///< as that of a mesh

  /// Calls visit(a, b) for the edges that are walls.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::size_t k = 0; k < profile.size(); ++k) {
      const Vector<2>&a = profile[k], &b = profile[(k + 1) % profile.size()];
      if (a != b && (a[0] != 0 || b[0] != 0)) visit(a, b);
    }
  }
};

/// Throws Error{bad_argument} with one line unless base and axis are finite, the axis is not zero, no corner
/// of the profile has a negative distance from it, and its edges meet nowhere but at the ends of neighbours,
/// see `require_simple`. Exact.
void require_profile(const Revolved&);

using Domain = std::variant<Box, Cylinder, Sphere, Mesh, Polygon, Revolved>;

/// "box", "cylinder", "sphere", "mesh", "polygon", "revolved"; "periodic" for a box that repeats itself along
/// some axis.
std::string_view kind_of(const Domain&);
/// What to call it in a sentence: "cylinder", "periodic cylinder", "periodic mesh", "periodic box", "tilted
/// periodic box", "box periodic but along axis 2".
std::string name_of(const Domain&);

int dimension_of(const Domain&);
/// Whether it ends anywhere.
bool has_walls(const Domain&);
/// Whether it repeats itself along some axis.
bool is_periodic(const Domain&);
inline bool is_tilted(const Domain& domain) {
  const auto* box = std::get_if<Box>(&domain);
  return box && box->is_tilted();
}
/// Throws Error{bad_argument} for a tilted periodic box, of which `what` ("a mesh") is not known.
void require_upright(const Domain&, std::string_view what);
inline bool is_repeated_mesh(const Domain& domain) {
  const auto* mesh = std::get_if<Mesh>(&domain);
  return mesh && mesh->repeats();
}
/// Throws Error{bad_argument} for a mesh that repeats itself, of which `what` ("a mesh") is not known.
void require_closed_walls(const Domain&, std::string_view what);
/// Whether its walls are many pieces, which may leave room anywhere: a mesh, a polygon or a solid of
/// revolution.
inline bool is_faceted(const Domain& domain) {
  return std::holds_alternative<Mesh>(domain) || std::holds_alternative<Polygon>(domain) ||
         std::holds_alternative<Revolved>(domain);
}
/// How far spheres are kept off its walls beside their gaps: of a mesh with the surface of a CAD file as far
/// as the two may be apart.
inline double margin_of(const Domain& domain) {
  const auto* mesh = std::get_if<Mesh>(&domain);
  return mesh ? mesh->margin() : 0;
}
/// How many independent motions, shifts and turns, take the domain into itself for as far as they go: a shift
/// along each axis that repeats itself, a turn about the axis of a cylinder or of a profile, three about a
/// sphere's centre. A polygon has none, a mesh shifts along which it is the same everywhere.
int symmetries_of(const Domain&);

/// Smallest axis-aligned bounds, to rounding; along an axis that repeats itself, one period, and of a tilted
/// box the brick of a `TiltedBoundary`. Precondition: D is the dimension, or dynamic; or D is 3 and the
/// domain one of the plane z = 0.
template <int D = 3>
Bounds<D> bounds_of(const Domain&);
/// Enclosed volume, or that of one period, to rounding; an area in two dimensions, and so on. (For a mesh
/// the sum of signed tetrahedra about its bounds' centre.) With an inset to first order in that.
double volume_of(const Domain&);
/// Area of the walls, in two dimensions their length; precondition: two or three dimensions.
double area_of(const Domain&);
/// The metric: the periods of the axes that have one. Throws Error{bad_argument} for a tilted box, so that
/// nothing that knows upright ones only takes it for one. Precondition: D is the dimension.
template <int D>
Boundary<D> boundary_of(const Domain&);
/// The same for those who know tilted boxes.
template <int D>
TiltedBoundary<D> tilted_boundary_of(const Domain&);
/// The metric in space of a domain of two or three dimensions: one in the plane z = 0 has no period along z.
Boundary<3> boundary_in_space(const Domain&);

/// The domain with all its walls moved inwards by so much, or outwards where that is negative; what repeats
/// itself stays as it is. Rounded inwards, by some roundoffs of the coordinates, and not at all where every
/// sum is a double: a ball of radius r that lies inside has a clearance of r + `by` from the walls before.
/// Sizes become negative where nothing is left. Throws Error{bad_argument} for a mesh, a polygon or a solid
/// of revolution that has an inset already.
Domain with_walls_moved(const Domain&, double by);

/// Replaces every centre by its image in one period: that in [lower, lower + period) along axes that have
/// one, where results and files have them. Precondition: spheres of the domain's dimension.
void wrap(Spheres<dynamic>&, const Domain&);

/// A similarity that takes the scene's coordinates to the packer's: local = (scene - origin) / scale, with
/// `scale` a power of two, so that scaling is exact and the local domain has a diagonal in [1, 2).
struct Frame {
  Vector<3> origin = Vector<3>::Zero();
  double scale = 1;
  double resolution = 0;  ///< largest rounding error of a coordinate on the way back, in local lengths

  Vector<3> to_local(const Vector<3>& p) const { return (p - origin) / scale; }
  Vector<3> to_scene(const Vector<3>& p) const { return origin + scale * p; }
};

/// The frame centred on the bounds of a domain of three dimensions, or of two in the plane z = 0.
Frame frame_of(const Domain&);

/// The domain in local coordinates; corners and vertices are rounded to within `frame.resolution`, periods
/// are not rounded.
Domain to_local(const Domain&, const Frame&);

}  // namespace bernal
