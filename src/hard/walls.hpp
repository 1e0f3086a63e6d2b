#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "hard/flying_sphere.hpp"
#include "hard/neighbor_pool.hpp"
#include "hard/wall.hpp"

namespace bernal {

/// The walls of a convex region around flying spheres. As `Shells` does for neighbours it keeps for each
/// sphere the walls that it could meet before it has left its shell.
///
/// Invariant: those are all walls, and no others, nearer to its home than its reach. Those that come near a
/// cell of a coarse grid are known once and for all, so that a container of thousands of planes costs a
/// sphere no more than the planes about it. Cost: 4 ns a wall near enough; a sphere far from all walls looks
/// at one empty list. Memory: about 80 bytes a sphere.
template <int D>
class Walls {
 public:
  using Id = std::uint32_t;

  /// Of a region within [0, edge).
  Walls(std::vector<Wall<D>> walls, const Vector<D>& edges) : walls_(std::move(walls)), edges_(edges) {}

  bool empty() const { return walls_.empty(); }

  /// Homes of `count` spheres to come by `settle`, with reaches up to `most`.
  void start(std::size_t count, double most);
  void settle(Id i, const Vector<D>& home, double reach);

  /// The time until sphere i, with this radius and growth of it, touches the first of its near walls, which
  /// is remembered; infinite if there is none.
  double time_to_touch(Id i, const FlyingSphere<D>& sphere, double radius, double growth);
  /// Sphere i touches the wall that it was last found to meet and is reflected from it, elastically with
  /// respect to its growing surface: v_n -> -v_n - 2 r', v_n being its velocity out of the region. Returns
  /// the momentum that the wall takes, at least `least`; the mass is 1.
  double reflect(Id i, FlyingSphere<D>& sphere, double growth, double least) const;

 private:
  void fill_cells(const Vector<D>& lower, const Vector<D>& size, int level, std::size_t first,
                  const std::vector<Id>& near);
  std::size_t cell_at(const Vector<D>& home) const;

  std::vector<Wall<D>> walls_;
  Vector<D> edges_;
  double reach_ = -1;  // that the cells are good for
  int cells_an_edge_ = 1;
  std::vector<std::vector<Id>> cells_;  // walls nearer to a cell than reach_
  NeighborPool near_;
  std::vector<Id> found_;
  std::vector<Id> next_;  // the wall that a sphere meets
};

}  // namespace bernal
