#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/archive.hpp"
#include "core/made.hpp"
#include "hard/flying_sphere.hpp"
#include "hard/neighbor_pool.hpp"

namespace bernal {

/// A piece of the wall around a convex region, as what is inside sees it. The region is where all its pieces
/// have a clearance of 0 or more:
///
/// | round | along               | center            | extent | clearance of p                    |
/// |-------|---------------------|-------------------|--------|-----------------------------------|
/// | no    | unit normal, out    |                   | o      | o - n·p                           |
/// | yes   | unit axis: cylinder | a point of the axis | R    | R - |P (p - center)|, P across it |
/// | yes   | 0: sphere           | centre            | R      | R - |p - center|                  |
template <int D>
struct Wall {
  bool round = false;
  Vector<D> along = Vector<D>::Zero();
  Vector<D> center = Vector<D>::Zero();
  double extent = 0;

  Vector<D> across(const Vector<D>& v) const { return v - v.dot(along) * along; }
  double clearance(const Vector<D>& p) const {
    return round ? extent - across(p - center).norm() : extent - along.dot(p);
  }
  /// The unit normal out of the region where a sphere at p touches.
  Vector<D> outward(const Vector<D>& p) const { return round ? across(p - center).normalized() : along; }
  void shift(const Vector<D>& by) {
    center += by;
    if (!round) extent += along.dot(by);
  }

  /// The time until a sphere at p with velocity v, whose radius is r and grows by r' a unit of time, touches:
  /// 0 for one that already does, or overlaps by rounding, and comes closer; infinite where it never will.
  ///
  /// A plane: n·(p + v t) + r + r' t = o. A round wall: |d + w t| = s - r' t with d = P (p - center),
  /// w = P v, s = R - r; with a = w² - r'², b = d·w + s r', c = d² - s² that is a t² + 2 b t + c = 0, and
  /// from inside, c <= 0, the root that comes next is -c / (b + √(b² - a c)) where b > 0, else
  /// (√(b² - a c) - b) / a, neither of which cancels. A sphere that is outside by rounding and flies along
  /// the wall without getting in again, b² < a c, collides where it is nearest to the inside.
  double time_to_touch(const Vector<D>& p, const Vector<D>& v, double r, double growth) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!round) {
      const double closing = along.dot(v) + growth;
      return closing > 0 ? std::max(0.0, extent - along.dot(p) - r) / closing : never;
    }
    const Vector<D> d = across(p - center), w = across(v);
    const double s = extent - r;
    const double a = w.squaredNorm() - growth * growth, b = d.dot(w) + s * growth;
    const double c = d.squaredNorm() - s * s;
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    if (b > 0) return std::max(0.0, -c) / (b + root);
    return a > 0 ? (root - b) / a : never;
  }
};

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

  /// The time until sphere i, at p with velocity v, with this radius and growth of it, touches the first of
  /// its near walls, which is remembered; infinite if there is none.
  double time_to_touch(Id i, const Vector<D>& p, const Vector<D>& v, double radius, double growth);
  /// Sphere i, at p, touches the wall that it was last found to meet and is reflected from it, elastically
  /// with respect to its growing surface: v_n -> -v_n - 2 r', v_n being its velocity out of the region.
  /// Returns the momentum that the wall takes, at least `least`; the mass is 1.
  double reflect(Id i, const Vector<D>& p, Vector<D>& v, double growth, double least) const;

  /// What it knows of spheres, of the same walls.
  void archive(Archive& a) { a(reach_, levels_, cells_, near_, lists_, next_); }

 private:
  void fill_cells(const Vector<D>& lower, const Vector<D>& size, int level, std::size_t first,
                  const std::vector<Id>& near);

  std::optional<Made> made_;  // where there are walls
  std::vector<Wall<D>> walls_;
  Vector<D> edges_;
  double reach_ = -1;                   // that the cells are good for
  int levels_ = 0;                      // of cells: 2^levels_ along each edge
  std::vector<std::vector<Id>> cells_;  // walls nearer to a cell than reach_
  NeighborPool near_;
  std::vector<NeighborPool::List> lists_;  // in near_, of each sphere
  std::vector<Id> found_;
  std::vector<Id> next_;  // the wall that a sphere meets
};

}  // namespace bernal
