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

/// The kind of a triangle: the face of the period that it lies in, as Cut::face, or one of these.
inline constexpr std::int8_t in_contact_cut = -1, on_sphere = -2, on_wall = -3;

/// A closed surface in single precision, or a part of one; corners counter-clockwise from outside.
struct FloatSurface {
  std::vector<FloatPoint> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::int8_t> faces;  ///< of each triangle
};

/// The largest displacement when coordinates up to `largest` are rounded to single precision: half a unit in
/// the last place each, at most 2^-24 of the value, or 2^-150 on underflow.
double single_precision_shift(double largest);

/// Whether the point is nearer to the centre than the radius, for the exact real numbers. Exact.
bool lies_within(const FloatPoint& p, const Vector<3>& center, double radius);

/// Totals over the surfaces of all spheres.
struct SurfaceMeasures {
  std::uint64_t surfaces = 0, vertices = 0, triangles = 0;
  double deflection = 0;        ///< largest distance of a point of a true sphere from its triangles, over r
  double volume_share = 0;      ///< volume of the polyhedra over that of the spheres
  FloatPoint lower{}, upper{};  ///< bounds; zero without surfaces
};

/// Spheres as closed surfaces of triangles in single precision, cut at the ends of the periods and at
/// contacts.
///
/// Every vertex, as the exact real numbers of its floats, lies in the open ball of the sphere (or of its
/// image) with its radius reduced by `4 shift`; each is tested in exact arithmetic if a double bound cannot
/// decide. As balls are convex, so does every triangle. So the surfaces of spheres that do not overlap do not
/// even touch, and remain apart if a reader rounds decimals differently (1 shift) and if walls were rounded
/// in the same way (2 shifts). To achieve this, corners are placed `5 shift` below the sphere before
/// rounding.
///
/// At opposite ends of a period the polygons are the same, corner by corner: their floats are equal except
/// along the axis, where they are those of the two ends. All pieces of a sphere are cut from one polyhedron.
/// Throws for a sphere that cannot be cut in this way.
class SphereSurfaces {
 public:
  /// `pieces` are from `pieces_of` the domain, possibly with further cuts at contacts; every piece of a
  /// sphere has the cuts of its others. `shift` is single_precision_shift of all coordinates in the file.
  /// Throws Error{bad_argument} if a sphere is so small that rounding would take more than a quarter of the
  /// deflection. Precondition: 0 < deflection < 1.
  SphereSurfaces(std::vector<Piece> pieces, const Domain& domain, double deflection, double shift);

  std::size_t spheres() const { return first_piece_.size() - 1; }
  /// Whether the sphere is one piece without a cut.
  bool is_whole(std::size_t sphere) const;
  const Piece& first_piece(std::size_t sphere) const { return pieces_[first_piece_[sphere]]; }
  double radius(std::size_t sphere) const { return first_piece(sphere).radius; }
  /// Frequency of the icosphere for whole spheres.
  int frequency() const { return frequency_; }
  /// The difference between a sphere's radius and that of the ball that contains its surface.
  double inset() const { return 4 * shift_; }

  /// Calls visit for each nonempty piece of the sphere. Cost: 20 ns a triangle, and some tens of µs for a cut
  /// sphere.
  void visit(std::size_t sphere, const std::function<void(const FloatSurface&)>& visit) const;
  /// Totals over all spheres, in threads. Throws std::logic_error if a vertex is outside its ball.
  SurfaceMeasures measure() const;

 private:
  struct Measured {
    double volume = 0, inner = 0;  ///< inner: least distance of a triangle on the sphere from the centre
  };
  void make(std::size_t sphere, const std::function<void(const FloatSurface&, const Measured&)>& use) const;
  /// False if a cut fails because of rounding or slivers.
  bool make_cut(std::size_t sphere, int frequency, std::vector<FloatSurface>& to, Measured& measured) const;
  void verify(const Piece& piece, const Vector<3>& home, const FloatSurface& surface) const;

  std::vector<Piece> pieces_;
  std::vector<std::size_t> first_piece_;
  Boundary<3> boundary_;
  double deflection_, shift_;
  int frequency_;
};

}  // namespace bernal
