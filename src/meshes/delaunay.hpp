#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The Delaunay triangulation of points on a sphere about the origin, which is their convex hull, or in the
/// plane z = 0, which is the upper hull of points lifted to a paraboloid: points come one at a time, and each
/// replaces the triangles whose circumcircle it lies in (Bowyer 1981, Watson 1981). Edges that are `bound`
/// are never replaced.
///
/// Which points lie in which circles is decided exactly for points rounded to a grid of 2^-38 of the extent,
/// by 128-bit integers where doubles cannot tell; so the triangulation is that of points next to the given
/// ones, which is one of these too, since edges are far longer than the grid. Triangles run counterclockwise
/// as seen from outside, or from above. Cost of a point: O(1) from a triangle near it.
class Delaunay {
 public:
  enum class Surface { sphere, plane };
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  /// In the plane: the vertex beyond the hull, at the third corner of a triangle outside each of its edges.
  static constexpr std::uint32_t beyond = none - 1;

  struct Face {
    std::array<std::uint32_t, 3> corners;
    std::array<std::uint32_t, 3> beside;  ///< across the edge from corner k to the next
    std::array<bool, 3> bound;            ///< whether that edge is kept
    bool is_alive = true;
    std::uint32_t stamp = 0;  ///< another one whenever the corners are others
  };

  /// `extent`: the radius of the sphere; or the largest absolute coordinate in the plane.
  Delaunay(Surface surface, double extent);

  /// Begins with all these points, of which not all are in one plane (on one line). False if some have no
  /// place: they coincide with others.
  bool begin(std::span<const Vector<3>> points);
  /// The faces that a point would replace and their rim, from a face whose circumcircle it lies in.
  bool find_cavity(const Vector<3>& point, std::uint32_t from);
  /// Whether all triangles from the rim of the cavity to the point have positive area.
  bool is_star_shaped(const Vector<3>& point) const;
  /// Replaces the cavity that was found last. Returns the number of the new point; `fresh()` are its faces.
  std::uint32_t fill_cavity(const Vector<3>& point) { return fill_cavity(point, none); }
  /// A face whose circumcircle the point lies in; none if there is no such face.
  std::uint32_t locate(const Vector<3>& point, std::uint32_t from) const;

  struct RimEdge {
    std::uint32_t from, to, outside;
    bool bound;
  };
  std::span<const RimEdge> rim() const { return rim_; }
  std::span<const std::uint32_t> fresh() const { return fresh_; }

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Vector<3>>& points() const { return points_; }
  bool is_finite(const Face& f) const {
    return f.corners[0] != beyond && f.corners[1] != beyond && f.corners[2] != beyond;
  }
  /// Binds edges; false if one of them is no edge of the triangulation.
  bool bind(std::span<const std::array<std::uint32_t, 2>> edges);
  /// In the plane: lets edges that the triangulation lacks take the place of those that they cross, by flips,
  /// and binds them all; other edges become Delaunay again (Sloan 1993). False if an edge passes through a
  /// point or crosses a bound one.
  bool recover(std::span<const std::array<std::uint32_t, 2>> edges);
  /// Moves a point a little; the triangles stay what they are until `restore`.
  void move(std::uint32_t point, const Vector<3>& to);
  /// Flips edges that are not bound until all triangles have empty circumcircles again.
  void restore();

  /// On a sphere the centre of the empty cap over a face, in the plane the circumcentre.
  Vector<3> circumcenter(const Face&) const;
  double circumradius(const Face&) const;
  /// As seen from outside of the sphere or from above.
  bool runs_counterclockwise(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) const;

 private:
  using Whole = std::array<std::int64_t, 3>;
  Whole on_grid(const Vector<3>& p) const;
  bool sees(const Face& f, const Whole& p) const;
  bool is_left(std::uint32_t a, std::uint32_t b, const Whole& p) const;
  std::uint32_t add_face(const Face& f);
  std::uint32_t fill_cavity(const Vector<3>& point, std::uint32_t as);
  bool make_first(std::span<const Vector<3>> points, std::array<std::size_t, 4>& used);
  bool flip(std::uint32_t face, std::size_t edge);
  void swap_diagonal(std::uint32_t face, std::size_t edge);
  bool is_convex_about(std::uint32_t face, std::size_t edge) const;
  /// In the plane: 1 where the point is on the left of the line from a to b, -1 on the right, 0 on it.
  int side_of(std::uint32_t a, std::uint32_t b, std::uint32_t point) const;
  bool recover(std::uint32_t from, std::uint32_t to);
  std::pair<std::uint32_t, std::size_t> face_at(std::uint32_t a, std::uint32_t b) const;

  Surface surface_;
  double extent_;
  std::vector<Vector<3>> points_;
  std::vector<Whole> whole_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> dead_;
  std::vector<std::uint32_t> cavity_, fresh_;
  std::vector<RimEdge> rim_;
  std::uint32_t last_ = 0;
};

}  // namespace bernal
