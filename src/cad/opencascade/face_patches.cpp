#include "cad/opencascade/face_patches.hpp"

#include <GeomConvert.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "cad/opencascade/turned_spline.hpp"

namespace bernal::cad {
namespace {

using Swept = TrueSurface::Swept;
using Bezier = TrueSurface::Bezier;
using opencascade::handle;

Vector<3> coordinates(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

template <class Kind, class Base>
handle<Kind> as(const handle<Base>& geometry) {
  return handle<Kind>::DownCast(geometry);
}

/// The coefficients of 1, s, cos s, sin s.
using Terms = std::array<Vector<3>, 4>;

std::optional<Terms> terms_of(handle<Geom_Curve> curve) {
  while (const auto trimmed = as<Geom_TrimmedCurve>(curve)) curve = trimmed->BasisCurve();
  const Vector<3> zero = Vector<3>::Zero();
  if (const auto line = as<Geom_Line>(curve))
    return Terms{coordinates(line->Position().Location().XYZ()),
                 coordinates(line->Position().Direction().XYZ()), zero, zero};
  const auto conic = as<Geom_Conic>(curve);
  if (!conic) return {};
  const gp_Ax2& frame = conic->Position();
  double a = 0, b = 0;
  if (const auto circle = as<Geom_Circle>(curve))
    a = b = circle->Radius();
  else if (const auto ellipse = as<Geom_Ellipse>(curve))
    a = ellipse->MajorRadius(), b = ellipse->MinorRadius();
  else
    return {};
  return Terms{coordinates(frame.Location().XYZ()), zero, a * coordinates(frame.XDirection().XYZ()),
               b * coordinates(frame.YDirection().XYZ())};
}

/// What stands at the distance `slope` v + `radius` + `small` cos v from an axis and at `rise` v + `small`
/// sin v along it.
struct Round {
  double radius, slope, small, rise;
};

Swept swept_of(const gp_Ax3& frame, const Round& round) {
  const Vector<3> x = coordinates(frame.XDirection().XYZ()), y = coordinates(frame.YDirection().XYZ()),
                  z = coordinates(frame.Direction().XYZ());
  Swept swept;
  swept.c[0] = {coordinates(frame.Location().XYZ()), round.rise * z, Vector<3>::Zero(), round.small * z};
  swept.c[2] = {round.radius * x, round.slope * x, round.small * x, Vector<3>::Zero()};
  swept.c[3] = {round.radius * y, round.slope * y, round.small * y, Vector<3>::Zero()};
  return swept;
}

/// The curve turned about an axis: p = o + along + cos u across + sin u (z × across).
Swept turned(const gp_Ax1& axis, Terms curve) {
  const Vector<3> o = coordinates(axis.Location().XYZ()), z = coordinates(axis.Direction().XYZ());
  curve[0] -= o;
  Swept swept;
  for (int j = 0; j < 4; ++j) {
    const Vector<3> along = curve[j].dot(z) * z, across = curve[j] - along;
    swept.c[0][j] = along;
    swept.c[2][j] = across;
    swept.c[3][j] = z.cross(across);
  }
  swept.c[0][0] += o;
  return swept;
}

std::optional<Swept> swept_of(const handle<Geom_Surface>& surface) {
  if (const auto plane = as<Geom_Plane>(surface)) {
    const gp_Ax3& frame = plane->Position();
    Swept swept;
    swept.c[0][0] = coordinates(frame.Location().XYZ());
    swept.c[1][0] = coordinates(frame.XDirection().XYZ());
    swept.c[0][1] = coordinates(frame.YDirection().XYZ());
    return swept;
  }
  if (const auto cylinder = as<Geom_CylindricalSurface>(surface))
    return swept_of(cylinder->Position(), {cylinder->Radius(), 0, 0, 1});
  if (const auto cone = as<Geom_ConicalSurface>(surface))
    return swept_of(cone->Position(),
                    {cone->RefRadius(), std::sin(cone->SemiAngle()), 0, std::cos(cone->SemiAngle())});
  if (const auto sphere = as<Geom_SphericalSurface>(surface))
    return swept_of(sphere->Position(), {0, 0, sphere->Radius(), 0});
  if (const auto torus = as<Geom_ToroidalSurface>(surface))
    return swept_of(torus->Position(), {torus->MajorRadius(), 0, torus->MinorRadius(), 0});
  if (const auto revolved = as<Geom_SurfaceOfRevolution>(surface)) {
    if (const auto curve = terms_of(revolved->BasisCurve())) return turned(revolved->Axis(), *curve);
  } else if (const auto extruded = as<Geom_SurfaceOfLinearExtrusion>(surface)) {
    if (const auto curve = terms_of(extruded->BasisCurve())) {
      Swept swept;
      for (int i = 0; i < 4; ++i) swept.c[i][0] = (*curve)[i];
      swept.c[0][1] = coordinates(extruded->Direction().XYZ());
      return swept;
    }
  }
  return {};
}

Bezier bezier_of(const Geom_BezierSurface& patch, const Parameters& lower, const Parameters& upper) {
  Bezier bezier{{patch.UDegree(), patch.VDegree()}, lower, upper, {}};
  for (int i = 1; i <= patch.NbUPoles(); ++i)
    for (int j = 1; j <= patch.NbVPoles(); ++j) {
      const double w = patch.Weight(i, j);
      const gp_XYZ p = w * patch.Pole(i, j).XYZ();
      bezier.points.push_back({p.X(), p.Y(), p.Z(), w});
    }
  return bezier;
}

std::vector<double> values_of(const TColStd_Array1OfReal& array) { return {array.begin(), array.end()}; }

/// The same, with the ends of a period as knots.
handle<Geom_BSplineSurface> without_periods(const handle<Geom_BSplineSurface>& surface) {
  auto copy = as<Geom_BSplineSurface>(handle<Geom_Geometry>(surface->Copy()));
  if (copy->IsUPeriodic()) copy->SetUNotPeriodic();
  if (copy->IsVPeriodic()) copy->SetVNotPeriodic();
  return copy;
}

}  // namespace

std::string kind_of(const handle<Geom_Surface>& given) {
  handle<Geom_Surface> surface = given;
  while (const auto trimmed = as<Geom_RectangularTrimmedSurface>(surface)) surface = trimmed->BasisSurface();

  if (as<Geom_Plane>(surface)) return "plane";
  if (as<Geom_CylindricalSurface>(surface)) return "cylinder";
  if (as<Geom_ConicalSurface>(surface)) return "cone";
  if (as<Geom_SphericalSurface>(surface)) return "sphere";
  if (as<Geom_ToroidalSurface>(surface)) return "torus";
  if (as<Geom_BoundedSurface>(surface)) return "B-spline";
  if (as<Geom_SurfaceOfRevolution>(surface)) return "surface of revolution";
  if (as<Geom_SurfaceOfLinearExtrusion>(surface)) return "extrusion";
  if (as<Geom_OffsetSurface>(surface)) return "offset surface";
  return "surface of an unknown kind";
}

FacePatches::FacePatches(const handle<Geom_Surface>& given, const ParameterBox& box, TrueSurface& into)
    : surface_(into) {
  handle<Geom_Surface> surface = given;
  while (const auto trimmed = as<Geom_RectangularTrimmedSurface>(surface)) surface = trimmed->BasisSurface();
  if (surface.IsNull()) {
    kind_ = "face";
    without_bound_ = "it has no surface";
    return;
  }
  kind_ = kind_of(surface);
  if (const auto swept = swept_of(surface))
    of_cells_.push_back(*swept);
  else if (as<Geom_BoundedSurface>(surface))
    set_spline(surface);
  else if (as<Geom_SurfaceOfLinearExtrusion>(surface))
    set_extruded(surface, box);
  else if (const auto revolved = as<Geom_SurfaceOfRevolution>(surface)) {
    PatchGrid grid = turned_spline(*revolved);
    knots_ = std::move(grid.knots);
    period_ = grid.period;
    of_cells_ = std::move(grid.cells);
  }
  if (of_cells_.empty()) without_bound_ = "nothing bounds the derivatives of this kind of surface";
  for (const TrueSurface::Patch& patch : of_cells_)
    if (const auto* bezier = std::get_if<Bezier>(&patch);
        bezier && std::ranges::max(bezier->degree) > Bezier::most_degree)
      without_bound_ = "its degree is too high";
}

void FacePatches::set_spline(const handle<Geom_Surface>& surface) {
  if (const auto bezier = as<Geom_BezierSurface>(surface)) {
    of_cells_.push_back(bezier_of(*bezier, {0, 0}, {1, 1}));
    return;
  }
  const auto spline = as<Geom_BSplineSurface>(surface);
  if (spline.IsNull()) return;
  if (spline->IsUPeriodic()) period_[0] = spline->UPeriod();
  if (spline->IsVPeriodic()) period_[1] = spline->VPeriod();
  GeomConvert_BSplineSurfaceToBezierSurface parts(without_periods(spline));
  TColStd_Array1OfReal u(1, parts.NbUPatches() + 1), v(1, parts.NbVPatches() + 1);
  parts.UKnots(u);
  parts.VKnots(v);
  knots_ = {values_of(u), values_of(v)};
  for (int i = 1; i <= parts.NbUPatches(); ++i)
    for (int j = 1; j <= parts.NbVPatches(); ++j)
      of_cells_.push_back(bezier_of(*parts.Patch(i, j), {u(i), v(j)}, {u(i + 1), v(j + 1)}));
}

/// An extruded curve without a closed form: of a spline the Bézier patches of degree 1 along v.
void FacePatches::set_extruded(const handle<Geom_Surface>& surface, const ParameterBox& box) {
  const auto extruded = as<Geom_SurfaceOfLinearExtrusion>(surface);
  handle<Geom_Curve> curve = extruded->BasisCurve();
  while (const auto trimmed = as<Geom_TrimmedCurve>(curve)) curve = trimmed->BasisCurve();
  const auto spline = as<Geom_BSplineCurve>(curve);
  const auto bezier = as<Geom_BezierCurve>(curve);
  if (spline.IsNull() && bezier.IsNull()) return;
  // Both have the parameters of the curve, as a spline with a second row of points.
  const auto poles = spline.IsNull() ? GeomConvert::CurveToBSplineCurve(bezier) : spline;
  const auto open = as<Geom_BSplineCurve>(handle<Geom_Geometry>(poles->Copy()));
  if (open->IsPeriodic()) {
    period_[0] = open->Period();
    open->SetNotPeriodic();
  }
  const double low = box.lower[1], high = std::max(box.upper[1], low + 1e-9 * (1 + std::abs(low)));
  const int n = open->NbPoles();
  TColgp_Array2OfPnt points(1, n, 1, 2);
  TColStd_Array2OfReal weights(1, n, 1, 2);
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= 2; ++j) {
      points(i, j) = open->Pole(i).XYZ() + (j == 1 ? low : high) * extruded->Direction().XYZ();
      weights(i, j) = open->Weight(i);
    }
  TColStd_Array1OfReal ends(1, 2);
  ends(1) = low, ends(2) = high;
  TColStd_Array1OfInteger twice(1, 2);
  twice.Init(2);
  const double period = period_[0];
  set_spline(new Geom_BSplineSurface(points, weights, open->Knots(), ends, open->Multiplicities(), twice,
                                     open->Degree(), 1));
  period_[0] = period;
}

std::int64_t FacePatches::cell_of(int axis, double at) const {
  const std::vector<double>& knots = knots_[axis];
  if (knots.empty()) return 0;
  const auto cells = static_cast<std::int64_t>(knots.size()) - 1;
  std::int64_t periods = 0;
  if (period_[axis] > 0) {
    periods = static_cast<std::int64_t>(std::floor((at - knots.front()) / period_[axis]));
    at -= static_cast<double>(periods) * period_[axis];
  }
  const auto next = std::upper_bound(knots.begin(), knots.end(), at) - knots.begin();
  return periods * cells + std::clamp<std::int64_t>(next - 1, 0, cells - 1);
}

double FacePatches::end_of(int axis, std::int64_t cell) const {
  const std::vector<double>& knots = knots_[axis];
  if (knots.empty()) return std::numeric_limits<double>::infinity();
  const auto cells = static_cast<std::int64_t>(knots.size()) - 1;
  const auto periods = cell >= 0 ? cell / cells : -((cells - 1 - cell) / cells);
  if (period_[axis] == 0 && cell >= cells - 1) return std::numeric_limits<double>::infinity();
  return knots[static_cast<std::size_t>(cell - periods * cells + 1)] +
         static_cast<double>(periods) * period_[axis];
}

std::uint32_t FacePatches::patch_of(const Cell& cell) {
  const auto [entry, is_new] = made_.try_emplace(cell, static_cast<std::uint32_t>(surface_.patches.size()));
  if (!is_new) return entry->second;
  std::array<std::int64_t, 2> within{};
  std::array<double, 2> shift{};
  for (int k = 0; k < 2; ++k) {
    if (knots_[k].empty()) continue;
    const auto cells = static_cast<std::int64_t>(knots_[k].size()) - 1;
    const auto periods = cell[k] >= 0 ? cell[k] / cells : -((cells - 1 - cell[k]) / cells);
    within[k] = cell[k] - periods * cells;
    shift[k] = static_cast<double>(periods) * period_[k];
  }
  const auto columns = knots_[1].empty() ? 1 : static_cast<std::int64_t>(knots_[1].size()) - 1;
  TrueSurface::Patch patch = of_cells_[static_cast<std::size_t>(within[0] * columns + within[1])];
  if (auto* bezier = std::get_if<Bezier>(&patch))
    for (int k = 0; k < 2; ++k) bezier->lower[k] += shift[k], bezier->upper[k] += shift[k];
  surface_.patches.push_back(std::move(patch));
  return entry->second;
}

Vector<3> FacePatches::point_at(const Parameters& at) {
  return bernal::point_at(surface_.patches[patch_of({cell_of(0, at[0]), cell_of(1, at[1])})], at);
}

DerivativeBounds FacePatches::derivative_bounds(const ParameterBox& box) {
  DerivativeBounds largest;
  for (auto i = cell_of(0, box.lower[0]); i <= cell_of(0, box.upper[0]); ++i)
    for (auto j = cell_of(1, box.lower[1]); j <= cell_of(1, box.upper[1]); ++j) {
      const DerivativeBounds here = bernal::derivative_bounds(surface_.patches[patch_of({i, j})], box);
      largest.u = std::max(largest.u, here.u);
      largest.v = std::max(largest.v, here.v);
    }
  return largest;
}

void FacePatches::append(const ParameterTriangle& triangle, std::uint32_t flat, double slack) {
  cut({triangle.begin(), triangle.end()}, 0, {}, flat, slack);
}

/// Cuts a convex polygon at the ends of cells along `axis`, then along the next, and appends the triangles of
/// a fan.
void FacePatches::cut(Polygon polygon, int axis, Cell cell, std::uint32_t flat, double slack) {
  if (axis == 2) {
    const std::uint32_t patch = patch_of(cell);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      surface_.pieces.push_back({patch, flat, {polygon[0], polygon[k], polygon[k + 1]}, slack});
    return;
  }
  const auto along = [axis](const Parameters& p) { return p[axis]; };
  const double last = along(*std::ranges::max_element(polygon, {}, along));
  for (cell[axis] = cell_of(axis, along(*std::ranges::min_element(polygon, {}, along)));; ++cell[axis]) {
    const double end = end_of(axis, cell[axis]);
    if (!(last > end)) {
      cut(std::move(polygon), axis + 1, cell, flat, slack);
      return;
    }
    Polygon below, above;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Parameters &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      if (p[axis] <= end) below.push_back(p);
      if (p[axis] >= end) above.push_back(p);
      if ((p[axis] < end && end < q[axis]) || (q[axis] < end && end < p[axis])) {
        const double share = (end - p[axis]) / (q[axis] - p[axis]);
        Parameters at{p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])};
        at[axis] = end;
        below.push_back(at);
        above.push_back(at);
      }
    }
    cut(std::move(below), axis + 1, cell, flat, slack);
    polygon = std::move(above);
  }
}

}  // namespace bernal::cad
