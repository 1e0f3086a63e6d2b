#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/geometry/mesh.hpp"
#include "meshes/round_surface.hpp"
#include "solids/solids.hpp"

namespace bernal {

/// A part of the surface that lies on one sphere, neck, wall or end of a period.
struct SurfacePatch {
  enum class Kind {
    sphere,    ///< index: the sphere's in the packing
    neck,      ///< index: its place in `ConformingSurface::necks`, the same for images
    cut_face,  ///< the flat face of a cap, or where a neck begins inside a sphere; index: the sphere's
    wall,  ///< index: 0 to 5 of a box as Cut::face; of a cylinder 0 its side, 1 its floor, 2 its lid; 0 of a
           ///< sphere; of a mesh its planar part, or the first of those triangulated as one
    period_end,  ///< index: Cut::face
    layer,       ///< the sphere on which a layer begins that is not the innermost; index: the sphere's
  };
  Kind kind = Kind::sphere;
  std::uint32_t index = 0;
  /// Behind the triangles and in front of them, where their normals point; `nothing` where no mesh is made.
  std::array<std::int32_t, 2> regions = {nothing, nothing};
  static constexpr std::int32_t nothing = -1;
  RoundSurface shape = {};  ///< what the triangles stand for
  std::string name = {};    ///< of a wall that has one of its own, where fluid enters or leaves
};

/// What a volume mesher fills.
struct MeshRegion {
  std::string group;                         ///< "fluid", "spheres" or "bridges"
  std::optional<std::uint32_t> sphere = {};  ///< for a piece of a sphere: its index in the packing
  std::optional<std::uint32_t> layer = {};   ///< of a sphere with layers: which, from the centre out
  /// In closed form, of all pieces of a sphere or layer together at the first of them, and of a bridge at the
  /// first of its images, 0 at others; nothing where caps are cut off, whose volume is known in sum only.
  std::optional<double> volume = {};
};

/// Tetrahedra that are made with a surface: prisms of thin layers, each cut in three.
struct PrismLayers {
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;  ///< as of VolumeMesh
  std::vector<std::uint32_t> region;                     ///< of each; such regions have no others
  bool empty() const { return tetrahedra.empty(); }
};

/// Where solids that are no regions meet walls and ends of periods: triangles that close the holes of these.
struct SurfaceLids {
  std::vector<Vector<3>> vertices;     ///< numbered after those of the surface
  std::vector<FaceCorners> triangles;  ///< of both
  /// Chains of vertices across lids, where the plane of a rim meets them in which a neck begins.
  std::vector<std::vector<std::uint32_t>> chords;
};

/// A neck as it was meshed: its radius may be other than asked for.
struct MeshedNeck {
  /// The second is absent where the neck stands on a wall.
  std::uint32_t sphere = 0;
  std::optional<std::uint32_t> other = {};
  std::uint32_t wall = 0;  ///< as SurfacePatch::index of walls
  double radius = 0;
};

/// What is known of the surface beside its triangles. Volumes and areas are those of one period.
struct SurfaceStatement {
  double least_edge = 0, least_angle = 0;  ///< of all triangles; the angle in degrees
  double least_angle_off_necks = 0;        ///< of all triangles that do not lie on necks, in degrees
  Vector<3> place_of_least_angle = Vector<3>::Zero();
  /// Whose radius is smaller than asked for, so that others and ends of periods stay clear.
  std::size_t shrunk_necks = 0;
  double largest_shrink = 0;      ///< over the radius asked for
  std::size_t cut_fillets = 0;    ///< that are cylinders, as ends of periods would cut or nearly touch them
  std::size_t widened_necks = 0;  ///< by up to three tenths, so that ends of periods cut them clearly
  std::size_t deepened_caps = 0;  ///< that are deeper than the gap asks for, for the same reason
  double fluid_volume = 0;  ///< in closed form; where caps of a sphere meet, what they share is counted twice
  double meshed_fluid_volume = 0;  ///< between the triangles
  double contact_area = 0;         ///< least cross-sections of necks, flat faces of caps
  double wall_deviation = 0;       ///< how far triangles of walls of a mesh are off it, at most
};

/// The triangles that bound the fluid and, where asked for, the solids of a bed: every patch once, also where
/// it lies between two regions. The boundary of each region is closed, triangles meet only in common edges
/// and corners, and normals of patches of spheres, necks and flat faces point into the fluid, those of walls
/// and ends of periods out of the domain.
struct ConformingSurface {
  std::vector<Vector<3>> vertices;
  std::vector<FaceCorners> triangles;
  std::vector<std::uint32_t> patch;  ///< of each triangle
  std::vector<SurfacePatch> patches;
  std::vector<MeshRegion> regions;  ///< the first is the fluid
  std::vector<MeshedNeck> necks;
  /// Vertices of opposite ends of periods, (lower, upper) by axis: equal but for the coordinate along it.
  std::array<std::vector<std::array<std::uint32_t, 2>>, 3> periodic;
  std::vector<double> size;  ///< the length of edges asked for at each vertex
  PrismLayers prisms;
  SurfaceLids lids;
  SurfaceStatement statement;
};

struct SurfaceMeshOptions {
  double sphere_edge = 0.3;  ///< longest edges on spheres, in radii
  /// Longest edges on walls beside spheres, in the largest radius; twice those on spheres if 0.
  double wall_edge = 0;
  double neck_edge = 0.15;  ///< edges where necks begin, in radii of the smaller sphere
  double per_gap = 2;       ///< edges where surfaces are near each other, in widths of the gap there
  bool solids = false;      ///< whether what is inside spheres and necks is a region too
  /// Whether facets of spheres hold the volumes of these, see `hold_volume`, or their corners lie on them.
  bool hold_volumes = false;
  double per_layer = 6;  ///< edges on spheres with thin layers, in thicknesses of these; half of that
                         ///< where an end of a period cuts a layer so that no prisms fit into it
};

/// The surface of a bed, made without a Boolean kernel: points along the circles in which spheres are cut,
/// the Delaunay triangulation of each sphere outside of them, refined to the asked sizes, and walls and ends
/// of periods with the same points. Vertices lie on the true surfaces to rounding, so triangles of spheres
/// that do not overlap do not cross; with `hold_volumes` those inside of spheres' patches stand off them by
/// at most a fifth of the room to the next surface. The same for any number of threads.
///
/// Walls of a mesh are divided into their planar parts, see `PlanarWalls`, and those that are facets of a
/// curved wall are joined, see `SmoothWalls`; each is triangulated anew. Corners lie on the mesh, and
/// triangles across facets stand off it by at most some 2 % of the smallest radius, see
/// `SurfaceStatement::wall_deviation`; they stay clear of spheres, and no two cross, or facets are kept.
///
/// Precondition: solids of three dimensions in a box, a cylinder, both periodic or not, a sphere, or a mesh
/// without an inset in which bridges have room, see `solids_in_walls`. Throws
/// Error{bad_argument} with one line for other domains and for what it cannot make, Cancelled. Cost: O(N),
/// some milliseconds and some hundred vertices a sphere.
ConformingSurface conforming_surface(const Solids&, const SurfaceMeshOptions&, const Monitor& monitor = {});

}  // namespace bernal
