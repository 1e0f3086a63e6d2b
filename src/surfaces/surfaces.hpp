#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>

#include "bernal/core/monitor.hpp"
#include "bernal/surfaces/surface_choice.hpp"
#include "surfaces/sphere_surfaces.hpp"
#include "surfaces/wall_surface.hpp"

namespace bernal {

/// A part of a file: the container, or one piece of a sphere. Its triangles index the vertices of the whole
/// file; in the boundary of a pore space they may use the container's vertices at the ends of periods.
struct SurfacePart {
  std::optional<std::uint32_t> sphere;  ///< absent: the container
  std::uint32_t first_vertex = 0;       ///< index of the first vertex of its own
  std::span<const FloatPoint> vertices;
  std::span<const Triangle> triangles;
};

/// The triangles of a packing for a file, part by part: only the current part, the walls and the pieces are
/// in memory.
class Surfaces {
 public:
  /// Lengths in the file's unit. Throws Error{bad_argument} as SphereSurfaces and `wall_surface` do, and if
  /// the pore space is requested and spheres overlap at the end of a period.
  Surfaces(const Spheres<dynamic>& spheres, const Domain& domain, double deflection, SurfaceChoice choice,
           const Monitor& monitor)
      : Surfaces(spheres, domain, deflection, choice, monitor, {spheres.size(), false}) {}

  /// Of the spheres, those that lie within others: the first `outer` do not. Precondition: the choice is
  /// `spheres`, if there are any.
  struct Nested {
    std::size_t outer;
    bool are_holes;  ///< their triangles face inward
  };
  Surfaces(const Spheres<dynamic>& spheres, const Domain& domain, double deflection, SurfaceChoice choice,
           const Monitor& monitor, const Nested& nested);

  using Visit = std::function<void(const SurfacePart&)>;
  /// Calls visit for the container, if requested, and then for the spheres, all or in the given order. The
  /// parts are the same for each call with the same order.
  void visit(const Visit& visit) const { visit_spheres(nullptr, visit); }
  void visit(const std::vector<std::uint32_t>& order, const Visit& visit) const {
    visit_spheres(&order, visit);
  }

  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t triangles() const { return triangles_; }
  const FloatPoint& lower() const { return lower_; }
  const FloatPoint& upper() const { return upper_; }
  bool has_spheres() const { return choice_ != SurfaceChoice::container; }
  const SphereSurfaces& spheres() const { return spheres_; }
  const SurfaceMeasures& measures() const { return measures_; }
  /// The largest displacement by rounding to single precision.
  double shift() const { return shift_; }
  /// The walls with the faces at the ends of periods, as written; empty for spheres alone.
  const FloatSurface& container() const { return container_; }
  const WallSurface& walls() const { return walls_; }

  /// "1,000 surfaces of 320,000 triangles …": counts, distance from the spheres, what was proven.
  std::string note() const;

 private:
  void make_container(bool overlaps);
  void count();
  void visit_spheres(const std::vector<std::uint32_t>* order, const Visit& visit) const;

  SurfaceChoice choice_;
  Nested nested_;
  double deflection_;
  WallSurface walls_;
  double shift_ = 0;
  SphereSurfaces spheres_;
  const Monitor& monitor_;
  FloatSurface container_;
  std::map<FloatPoint, std::uint32_t> rim_;  ///< container vertices at the ends of periods
  SurfaceMeasures measures_;
  std::uint64_t vertices_ = 0, triangles_ = 0;
  FloatPoint lower_{}, upper_{};
  std::string proof_;
};

/// A point of the pore space with a lower bound on its distance from spheres and walls.
struct PorePoint {
  Vector<3> place;
  double clearance;
};

/// The point with the largest clearance among some thousand candidates, the best of which were moved away
/// from their nearest obstacles. It is proven, as in certificates, that the ball of that clearance meets no
/// sphere or image and lies inside the walls as written. Absent if no candidate lies in the pores. Cost: O(N)
/// a candidate.
std::optional<PorePoint> point_in_pores(const Spheres<dynamic>& spheres, const Domain& domain,
                                        const WallSurface& walls);

}  // namespace bernal
