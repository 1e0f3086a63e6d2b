#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/domain/container.hpp"
#include "bernal/geometry/mesh.hpp"
#include "solids/solids.hpp"

namespace bernal {

/// A planar part of walls that are triangles, with a frame of its own: u × v = outward.
struct FlatPart {
  Vector<3> origin = Vector<3>::Zero();  ///< in the plane, in the middle of the part's bounds
  Vector<3> outward = Vector<3>::UnitZ(), u = Vector<3>::UnitX(), v = Vector<3>::UnitY();
};

/// A straight line between two parts, or where one part meets itself.
struct FlatEdge {
  std::array<std::uint32_t, 2> corners = {};  ///< vertices of the mesh
  std::array<std::uint32_t, 2> parts = {};
};

/// A closed mesh as planar parts and the straight edges between them: edges within a part, and corners in the
/// middle of straight edges, are gone. Everything is at most `tolerance` off the mesh, a share of 1e-7 of its
/// diagonal.
struct PlanarWalls {
  std::vector<FlatPart> parts;
  std::vector<std::uint32_t> part_of_triangle;
  std::vector<FlatEdge> edges;
  double tolerance = 0;
};
/// Precondition: closed, oriented. Cost: O(T log T).
PlanarWalls flat_walls_of(const Mesh&);

/// Where bridges may stand on such walls.
class FlatFeet {
 public:
  /// The container is that of the mesh in its own frame, see `local_container`.
  FlatFeet(const Mesh&, const PlanarWalls&, std::shared_ptr<const Container> container);

  /// A part that is near a ball, and what is around the foot of a bridge on it.
  struct Foot {
    std::uint32_t part = 0;
    double distance = 0;  ///< of the part from the centre
    /// Of the nearest point of other parts, on this side of the part's plane, from the point of the part that
    /// is nearest to the centre, as far as it is below half a radius; 0 where that lies on an edge.
    double room = 0;
  };
  /// The parts that face c, nearer than `reach`, in the order of their numbers.
  std::vector<Foot> near(const Vector<3>& c, double r, double reach) const;

  /// The largest radius of a bridge of neck_edge · r at its rim that stands in this room. 0: none.
  static double radius_in(const Foot& foot, double asked, double edge);

 private:
  const PlanarWalls& walls_;
  Frame frame_;
  std::shared_ptr<const Container> container_;
};

/// Solids for a mesh of the pores. As `solids_of`, but for bridges in walls of triangles: a bridge stands
/// within a planar part, half an edge from its border. A sphere that is nearer than the gap to a part where
/// there is no room for at least half of the bridge's radius there is made smaller, about its centre, until
/// it has the gap from all walls. A solid of revolution becomes a mesh around it, whose flat sides touch it
/// and stand off it by at most 2 % of the smallest radius between.
struct SolidsInWalls {
  Solids solids;
  double wall_deviation = 0;      ///< how far walls stand off those of the domain, as a length
  std::size_t gaps_at_edges = 0;  ///< how many spheres are smaller for that
  double largest_shrink = 0;      ///< of their radii, over the radius
};
SolidsInWalls solids_in_walls(const Spheres<dynamic>&, const Domain&, const SolidsOptions&, double neck_edge,
                              const Monitor& monitor = {});

}  // namespace bernal
