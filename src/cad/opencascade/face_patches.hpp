#pragma once
#include <Geom_Surface.hxx>

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bernal/geometry/true_surface.hpp"
#include "geometry/curved_patch.hpp"

namespace bernal::cad {

using Parameters = std::array<double, 2>;

/// "plane", "B-spline", …
std::string kind_of(const opencascade::handle<Geom_Surface>&);

/// The formulas of one face, in patches over the cells of a grid of parameters, which are appended to a
/// surface when a piece needs them. Planes, cylinders, cones, spheres, tori, surfaces of revolution and
/// extrusions of lines, circles and ellipses are one patch; B-splines, their extrusions and surfaces of
/// revolution have one in each cell between knots, also in later periods.
class FacePatches {
 public:
  /// `box`: the parameters that the face covers.
  FacePatches(const opencascade::handle<Geom_Surface>&, const ParameterBox& box, TrueSurface& into);

  const std::string& kind() const { return kind_; }
  /// Why there are no patches; empty if there are.
  const std::string& without_bound() const { return without_bound_; }

  // Preconditions: there are patches.

  Vector<3> point_at(const Parameters&);
  /// Of the first derivatives, in all cells that the box meets.
  DerivativeBounds derivative_bounds(const ParameterBox&);
  /// Appends a triangle, cut where cells end.
  void append(const ParameterTriangle&, std::uint32_t flat, double slack);

 private:
  using Cell = std::array<std::int64_t, 2>;
  using Polygon = std::vector<Parameters>;

  void set_swept(const TrueSurface::Swept&);
  void set_spline(const opencascade::handle<Geom_Surface>&);
  void set_extruded(const opencascade::handle<Geom_Surface>&, const ParameterBox& box);

  /// The cell of a parameter along an axis, and where it ends.
  std::int64_t cell_of(int axis, double at) const;
  double end_of(int axis, std::int64_t cell) const;
  std::uint32_t patch_of(const Cell&);
  void cut(Polygon, int axis, Cell, std::uint32_t flat, double slack);

  TrueSurface& surface_;
  std::string kind_, without_bound_;
  std::array<std::vector<double>, 2> knots_;  ///< none: one cell
  std::array<double, 2> period_{};            ///< 0: none
  std::vector<TrueSurface::Patch> of_cells_;  ///< in one period, those along v together
  std::map<Cell, std::uint32_t> made_;
};

}  // namespace bernal::cad
