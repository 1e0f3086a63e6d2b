#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "bernal/domain/container.hpp"
#include "meshes/conforming_surface.hpp"
#include "near/point_grid.hpp"

namespace bernal {

/// Shares of a line, from 0 to 1 without these, that cut it into at least `least` pieces whose lengths are in
/// proportion to the sizes at their places and not above them. `size`: at a share of the line.
std::vector<double> spaced(double length, int least, const std::function<double(double)>& size);

/// A ball that is near a piece, from whose surface sizes follow.
struct NearBall {
  Vector<3> center;
  double radius;
  double floor;  ///< no smaller edges for its sake
};

/// The lengths of edges: a share of the radius on spheres, a multiple of the gap where surfaces are near each
/// other, and growing by `growth` times the distance from where they are short.
class MeshSizes {
 public:
  static constexpr double growth = 0.4;

  MeshSizes(const Solids&, const SurfaceMeshOptions&);

  /// Balls whose surfaces are near that of the sphere around `center`, itself left out; all images. At least
  /// those that are not farther than `reach`.
  std::vector<NearBall> near(const Vector<3>& center, std::uint32_t sphere, double reach = 0) const;
  /// Edges on a sphere at p, in the scene.
  double on_sphere(const Vector<3>& p, const Vector<3>& center, double radius, bool is_cut_at_end,
                   const std::vector<NearBall>& near) const;
  /// Edges on a wall or an end with this unit normal at p. `is_end`: balls may be cut by it.
  /// On flat walls far from all spheres they are as long as the distance lets them grow, up to 16 times the
  /// edges on the largest sphere.
  double on_wall(const Vector<3>& p, const Vector<3>& normal, bool is_end) const;
  /// Distance of p from the nearest wall and end of a period.
  double from_walls(const Vector<3>& p) const;
  double from_ends(const Vector<3>& p) const;
  /// Edges where a neck begins, and how many make up its circle. `height`: of the neck between its circles.
  std::size_t neck_count(double radius, double least_sphere, double height) const;

  /// Edges on flat faces of caps of a sphere.
  double at_caps(double radius) const {
    return std::min(options_.sphere_edge * radius, 2 * options_.per_gap * solids_.contacts.gap * radius);
  }

  double largest_radius() const { return largest_; }
  double least_radius() const { return spheres_.r.empty() ? 1 : std::ranges::min(spheres_.r); }
  /// The walls of a mesh, in its own frame; null for other domains.
  const std::shared_ptr<const Container>& container() const { return container_; }

 private:
  /// As `on_wall`, at most `most`.
  double on_wall_within(const Vector<3>& p, const Vector<3>& normal, bool is_end, double most) const;
  /// No edges are shorter for the sake of a contact with this gap between surfaces; 0 if it is not treated.
  /// `scale`: what gaps are shares of.
  double floor_at(double gap, double scale, double least_radius) const;

  const Solids& solids_;
  SurfaceMeshOptions options_;
  Boundary<3> boundary_;
  Spheres<3> spheres_;
  PointGrid<3> grid_;
  double largest_;
  bool has_necks_;
  std::shared_ptr<const Container> container_;
  Frame frame_;
};

}  // namespace bernal
