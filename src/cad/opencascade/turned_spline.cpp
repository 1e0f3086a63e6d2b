#include "cad/opencascade/turned_spline.hpp"

#include <GeomConvert.hxx>
#include <GeomConvert_BSplineCurveToBezierCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace bernal::cad {
namespace {

using opencascade::handle;
using Bezier = TrueSurface::Bezier;

constexpr int cells_of_turn = 32, degree_of_turn = 9;
using OfTurn = std::array<double, degree_of_turn + 1>;

/// From the coefficients of powers of s in [-1, 1] to those of Bernstein's polynomials of t = (s + 1) / 2.
OfTurn in_bernstein(const OfTurn& of_s) {
  OfTurn of_t{};
  for (int k = degree_of_turn; k >= 0; --k) {  // Horner's rule with s = 2 t - 1
    for (int i = degree_of_turn; i >= 0; --i) of_t[i] = (i > 0 ? 2 * of_t[i - 1] : 0) - of_t[i];
    of_t[0] += of_s[k];
  }
  OfTurn bernstein{};
  for (int i = 0; i <= degree_of_turn; ++i) {
    double share = 1;  // binomial(i, k) / binomial(n, k)
    for (int k = 0; k <= i; ++k) {
      bernstein[i] += share * of_t[k];
      share *= static_cast<double>(i - k) / (degree_of_turn - k);
    }
  }
  return bernstein;
}

/// cos and sin over [middle - half, middle + half].
std::array<OfTurn, 2> cosine_and_sine(double middle, double half) {
  OfTurn cosine{}, sine{};
  double term = 1;  // half^k / k!
  for (int k = 0; k <= degree_of_turn; term *= half / ++k) {
    cosine[k] = term * std::cos(middle + 0.5 * std::numbers::pi * k);
    sine[k] = term * std::sin(middle + 0.5 * std::numbers::pi * k);
  }
  return {in_bernstein(cosine), in_bernstein(sine)};
}

Vector<3> coordinates(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

}  // namespace

PatchGrid turned_spline(const Geom_SurfaceOfRevolution& surface) {
  PatchGrid grid;
  handle<Geom_Curve> curve = surface.BasisCurve();
  while (const auto trimmed = handle<Geom_TrimmedCurve>::DownCast(curve)) curve = trimmed->BasisCurve();
  auto spline = handle<Geom_BSplineCurve>::DownCast(curve);
  if (const auto bezier = handle<Geom_BezierCurve>::DownCast(curve))
    spline = GeomConvert::CurveToBSplineCurve(bezier);
  if (spline.IsNull()) return grid;
  const auto open = handle<Geom_BSplineCurve>::DownCast(handle<Geom_Geometry>(spline->Copy()));
  if (open->IsPeriodic()) {
    grid.period[1] = open->Period();
    open->SetNotPeriodic();
  }
  GeomConvert_BSplineCurveToBezierCurve arcs(open);
  TColStd_Array1OfReal knots(1, arcs.NbArcs() + 1);
  arcs.Knots(knots);
  grid.knots[1].assign(knots.begin(), knots.end());
  grid.period[0] = 2 * std::numbers::pi;
  for (int k = 0; k <= cells_of_turn; ++k) grid.knots[0].push_back(grid.period[0] * k / cells_of_turn);

  const Vector<3> o = coordinates(surface.Axis().Location().XYZ()),
                  z = coordinates(surface.Axis().Direction().XYZ());
  for (int cell = 0; cell < cells_of_turn; ++cell) {
    const double from = grid.knots[0][cell], to = grid.knots[0][cell + 1];
    const auto [cosine, sine] = cosine_and_sine(0.5 * (from + to), 0.5 * (to - from));
    for (int k = 1; k <= arcs.NbArcs(); ++k) {
      const handle<Geom_BezierCurve> arc = arcs.Arc(k);
      Bezier bezier{{degree_of_turn, arc->Degree()}, {from, knots(k)}, {to, knots(k + 1)}, {}};
      for (int i = 0; i <= degree_of_turn; ++i)
        for (int j = 1; j <= arc->NbPoles(); ++j) {
          const Vector<3> off = coordinates(arc->Pole(j).XYZ()) - o, along = off.dot(z) * z,
                          across = off - along;
          const double w = arc->Weight(j);
          const Vector<3> p = w * (o + along + cosine[i] * across + sine[i] * z.cross(across));
          bezier.points.push_back({p[0], p[1], p[2], w});
        }
      grid.cells.emplace_back(std::move(bezier));
    }
  }
  return grid;
}

}  // namespace bernal::cad
