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
#include "hard/faceted_walls.hpp"
#include "hard/flying_sphere.hpp"
#include "hard/neighbor_pool.hpp"

namespace bernal {

/// A piece of the wall around a convex region, which is where all its pieces have a clearance of at least 0:
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

  /// The time until a sphere at p with velocity v, whose radius r grows by r' a unit of time, touches: 0 if
  /// it already does, or overlaps by rounding, and approaches; infinite if it never will.
  ///
  /// A plane: n·(p + v t) + r + r' t = o. A round wall: |d + w t| = s - r' t with d = P (p - center), w = P
  /// v, s = R - r; with a = w² - r'², b = d·w + s r', c = d² - s² this is a t² + 2 b t + c = 0, and from
  /// inside, c <= 0, the next root is -c / (b + √(b² - a c)) if b > 0, else (√(b² - a c) - b) / a; neither
  /// cancels. A sphere that is outside by rounding and flies along the wall without entering again, b² < a c,
  /// collides where it is nearest to the inside.
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

/// The walls around flying spheres: those of a convex region, or the facets of any container. As `Shells`
/// does for neighbours, it stores for each sphere the walls that it could meet before it leaves its shell.
///
/// Invariant: these are exactly the walls nearer to its home than its reach. Those of a convex region that
/// are near each cell of a coarse grid are computed once, so that in a container of thousands of planes a
/// sphere costs no more than the planes around it. Cost: 4 ns a near wall; of facets 30 ns for each that may
/// come first, and a search each time that a sphere settles; a sphere far from all walls reads one empty
/// list. Memory: about 80 bytes a sphere, and 40 a near facet.
template <int D>
class Walls {
 public:
  using Id = std::uint32_t;

  /// For a region within [0, edge), between convex walls or in facets, which need two or three dimensions.
  Walls(std::vector<Wall<D>> walls, const Vector<D>& edges, const FacetedWalls* facets = nullptr)
      : walls_(std::move(walls)), facets_(facets), edges_(edges) {}

  bool empty() const { return walls_.empty() && !facets_; }

  /// Prepares for `count` spheres that will `settle`, with reaches up to `most`.
  void start(std::size_t count, double most);
  void settle(Id i, const Vector<D>& home, double reach);

  /// The time until sphere i, at p with velocity v, with this radius and growth, touches the first of its
  /// near walls, which is stored; infinite if there is none. It may be infinite where it is `limit` or later.
  double time_to_touch(Id i, const Vector<D>& p, const Vector<D>& v, double radius, double growth,
                       double limit = std::numeric_limits<double>::infinity());
  /// Reflects sphere i, at p, from the wall that time_to_touch stored, elastically relative to its growing
  /// surface: v_n -> -v_n - 2 r', with v_n its velocity out of the region. Returns the momentum received by
  /// the wall, at least `least`, for mass 1.
  double reflect(Id i, const Vector<D>& p, Vector<D>& v, double growth, double least) const;

  /// The data of the spheres, for the same walls.
  void archive(Archive& a) {
    a(reach_, levels_, cells_, near_, lists_, next_);
    if (facets_) a(views_);
  }

 private:
  /// The facets near a sphere, nearest first.
  struct View {
    Vector<D> home = Vector<D>::Zero();
    std::vector<FacetedWalls::Near> near = {};
    void archive(Archive& a) { a(home, near); }
  };

  double time_to_touch_facet(Id i, const Vector<D>& p, const Vector<D>& v, double radius, double growth,
                             double limit);
  Vector<D> outward(Id i, const Vector<D>& p) const;
  void fill_cells(const Vector<D>& lower, const Vector<D>& size, int level, std::size_t first,
                  const std::vector<Id>& near);

  std::optional<Made> made_;  // if there are walls
  std::vector<Wall<D>> walls_;
  const FacetedWalls* facets_;  // or null
  Vector<D> edges_;
  double reach_ = -1;                   // for which the cells are valid
  int levels_ = 0;                      // of cells: 2^levels_ along each edge
  std::vector<std::vector<Id>> cells_;  // walls nearer to a cell than reach_
  NeighborPool near_;
  std::vector<NeighborPool::List> lists_;  // in near_, for each sphere
  std::vector<Id> found_;
  std::vector<View> views_;  // of facets, for each sphere
  std::vector<Id> next_;     // the wall that each sphere meets
};

}  // namespace bernal
