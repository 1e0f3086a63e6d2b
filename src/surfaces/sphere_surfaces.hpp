#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "solids/pieces.hpp"

namespace bernal {

using FloatPoint = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

/// Of a triangle: the face of the period that it lies in, as Cut::face; else one of these.
inline constexpr std::int8_t in_contact_cut = -1, on_sphere = -2, on_wall = -3;

/// A closed surface in single precision, or one that others close; corners counter-clockwise from outside.
struct FloatSurface {
  std::vector<FloatPoint> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::int8_t> faces;  ///< of each triangle
};

/// How far a point of coordinates up to `largest` moves when these are rounded to single precision: each by
/// half a unit in the last place, 2^-24 of it at most, and by 2^-150 where that underflows.
double single_precision_shift(double largest);

/// Whether the point lies nearer to the centre than the radius, of the real numbers that these are. Exact.
bool lies_within(const FloatPoint& p, const Vector<3>& center, double radius);

/// What the surfaces of all spheres come to.
struct SurfaceMeasures {
  std::uint64_t surfaces = 0, vertices = 0, triangles = 0;
  double deflection = 0;    ///< the largest distance of a point of a true sphere from its triangles, over r
  double volume_share = 0;  ///< of the polyhedra, over the spheres'
  FloatPoint lower{}, upper{};  ///< bounds; of no surfaces all zero
};

/// Spheres as closed surfaces of triangles in single precision, cut at the ends of the periods and at
/// contacts.
///
/// Every vertex, taken for the real numbers that its floats are, lies in the open ball of the sphere (or of
/// its image) less `4 shift`; each is held against that in exact arithmetic where the bound of a double
/// cannot decide, and so, balls being convex, does every triangle. Spheres that do not overlap so have
/// surfaces that do not even touch, and stay apart where a reader takes decimals for doubles (1 shift)
/// and where walls were rounded in the same way (2 shifts). For that the corners are placed `5 shift` below
/// the sphere before they are rounded.
///
/// At opposite ends of a period the polygons are the same, corner by corner: across the axis the floats are
/// equal, and along it they are those of the two ends. All pieces of a sphere are cut from one polyhedron.
/// A sphere of which no polyhedron can be cut so is refused.
class SphereSurfaces {
 public:
  /// `pieces` as `pieces_of` gives them, of the domain, perhaps with further cuts at contacts: every piece of
  /// a sphere has those of its others. `shift` as single_precision_shift gives it for all coordinates that
  /// the file has. Throws Error{bad_argument} where a sphere is too small for that: rounding would take more
  /// than a quarter of the deflection. Precondition: 0 < deflection < 1.
  SphereSurfaces(std::vector<Piece> pieces, const Domain& domain, double deflection, double shift);

  std::size_t spheres() const { return first_piece_.size() - 1; }
  /// Whether the sphere has one piece, without a cut.
  bool is_whole(std::size_t sphere) const;
  const Piece& first_piece(std::size_t sphere) const { return pieces_[first_piece_[sphere]]; }
  double radius(std::size_t sphere) const { return first_piece(sphere).radius; }
  /// Of the icosphere that whole spheres have.
  int frequency() const { return frequency_; }
  /// What every ball is less than its sphere that holds what is written.
  double inset() const { return 4 * shift_; }

  /// Calls visit for each piece of the sphere of which something is left. Cost: 20 ns a triangle, and some
  /// tens of µs where there are cuts.
  void visit(std::size_t sphere, const std::function<void(const FloatSurface&)>& visit) const;
  /// Of all, in threads. Throws std::logic_error if a vertex is not where it is said to be.
  SurfaceMeasures measure() const;

 private:
  struct Measured {
    double volume = 0, inner = 0;  ///< the least distance of a triangle on the sphere from the centre
  };
  void make(std::size_t sphere, const std::function<void(const FloatSurface&, const Measured&)>& use) const;
  /// False where rounding or slivers have the better of a cut.
  bool make_cut(std::size_t sphere, int frequency, std::vector<FloatSurface>& to, Measured& measured) const;
  void verify(const Piece& piece, const Vector<3>& home, const FloatSurface& surface) const;

  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_piece_;
  Boundary<3> boundary_;
  double deflection_, shift_;
  int frequency_;
};

}  // namespace bernal
