#pragma once
#include <Geom_SurfaceOfRevolution.hxx>

#include <array>
#include <vector>

#include "bernal/geometry/true_surface.hpp"

namespace bernal::cad {

/// Patches over the cells of a grid of parameters, those along v together.
struct PatchGrid {
  std::array<std::vector<double>, 2> knots = {};
  std::array<double, 2> period = {};  ///< 0: none
  std::vector<TrueSurface::Patch> cells = {};
};

/// A spline turned about an axis, with the angle u and the curve's own parameter v. In a thirty-second of a
/// turn cos and sin are their Taylor polynomials about its middle, of degree 9: they are off by less than
/// (pi / 32)^10 / 10! < 3e-17, less than a roundoff. A quarter turn of a circle as a rational spline would be
/// exact, but has other parameters than the file. Without cells where the curve is no spline.
PatchGrid turned_spline(const Geom_SurfaceOfRevolution&);

}  // namespace bernal::cad
