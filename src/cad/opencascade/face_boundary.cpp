#include "cad/opencascade/face_boundary.hpp"

#include <BRep_Tool.hxx>
#include <Geom2dConvert_BSplineCurveToBezierCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_Curve.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <limits>

namespace bernal::cad {
namespace {

using opencascade::handle;

/// A curve in the plane of parameters: where it is not smooth, and how strongly it bends elsewhere.
class EdgeCurve {
 public:
  EdgeCurve(handle<Geom2d_Curve> curve, double first, double last) : curve_(curve) {
    while (const auto trimmed = handle<Geom2d_TrimmedCurve>::DownCast(curve)) curve = trimmed->BasisCurve();
    if (!handle<Geom2d_Line>::DownCast(curve).IsNull()) return;
    if (const auto circle = handle<Geom2d_Circle>::DownCast(curve)) {
      second_ = circle->Radius();
    } else if (const auto ellipse = handle<Geom2d_Ellipse>::DownCast(curve)) {
      second_ = ellipse->MajorRadius();
    } else if (const auto bezier = handle<Geom2d_BezierCurve>::DownCast(curve)) {
      add(*bezier, 0, 1);
    } else if (const auto spline = handle<Geom2d_BSplineCurve>::DownCast(curve)) {
      const auto part = handle<Geom2d_BSplineCurve>::DownCast(handle<Geom2d_Geometry>(spline->Copy()));
      if (!part->IsPeriodic())
        first = std::max(first, part->FirstParameter()), last = std::min(last, part->LastParameter());
      part->Segment(first, last);
      Geom2dConvert_BSplineCurveToBezierCurve arcs(part);
      TColStd_Array1OfReal knots(1, arcs.NbArcs() + 1);
      arcs.Knots(knots);
      const double shift = first - knots.First();  // by a period
      for (int k = 1; k <= arcs.NbArcs(); ++k) add(*arcs.Arc(k), knots(k) + shift, knots(k + 1) + shift);
    } else {
      throw Standard_Failure("nothing bounds an edge of its kind");
    }
  }

  Parameters at(double t) const {
    const gp_Pnt2d p = curve_->Value(t);
    return {p.X(), p.Y()};
  }

  /// The ends of what is smooth between two parameters.
  std::vector<double> cut(double from, double to) const {
    std::vector<double> all{from, to};
    for (const TrueSurface::Patch& arc : arcs_)
      if (const double end = std::get<TrueSurface::Bezier>(arc).upper[0]; from < end && end < to)
        all.push_back(end);
    std::ranges::sort(all);
    return all;
  }

  /// The largest second derivative between two parameters with nothing to cut between them.
  double bending(double from, double to) const {
    double largest = second_;
    for (const TrueSurface::Patch& arc : arcs_) {
      const auto& bezier = std::get<TrueSurface::Bezier>(arc);
      const double low = std::max(from, bezier.lower[0]), high = std::min(to, bezier.upper[0]);
      if (low < high) largest = std::max(largest, derivative_bounds(arc, {{low, 0}, {high, 0}}).uu);
    }
    return largest;
  }

 private:
  void add(const Geom2d_BezierCurve& arc, double from, double to) {
    TrueSurface::Bezier bezier{{arc.Degree(), 0}, {from, 0}, {to, 1}, {}};
    if (arc.Degree() > TrueSurface::Bezier::most_degree)
      throw Standard_Failure("the degree of an edge is too high");
    for (int k = 1; k <= arc.NbPoles(); ++k) {
      const double w = arc.Weight(k);
      bezier.points.push_back({w * arc.Pole(k).X(), w * arc.Pole(k).Y(), 0, w});
    }
    arcs_.push_back(std::move(bezier));
  }

  handle<Geom2d_Curve> curve_;
  double second_ = 0;
  std::vector<TrueSurface::Patch> arcs_;
};

ParameterBox box_around(const Parameters& a, const Parameters& b, double by) {
  const auto [left, right] = std::minmax(a[0], b[0]);
  const auto [low, high] = std::minmax(a[1], b[1]);
  return {{left - by, low - by}, {right + by, high + by}};
}

class LineMaker {
 public:
  /// Of the two curves of a seam that of the side on which the parameter t is at `p`.
  LineMaker(const TopoDS_Edge& edge, const TopoDS_Face& face, FacePatches& patches, double fine, double t,
            const gp_Pnt2d& p)
      : patches_(patches), fine_(fine), tolerance_(BRep_Tool::Tolerance(edge)) {
    double first = 0, last = 0;
    auto curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    const auto other = BRep_Tool::CurveOnSurface(TopoDS::Edge(edge.Reversed()), face, first, last);
    if (curve.IsNull() || other.IsNull()) throw Standard_Failure("an edge has no curve on it");
    if (other->Value(t).Distance(p) < curve->Value(t).Distance(p)) curve = other;
    curve_.emplace(curve, first, last);
    first_ = first, last_ = last;
    in_space_ = BRep_Tool::Curve(edge, first_in_space_, last_in_space_);
  }

  BoundaryLine line(double from, double to, const Parameters& start, const Parameters& end) {
    BoundaryLine line{{start}, {}, tolerance_};
    const std::vector<double> ends = curve_->cut(std::min(from, to), std::max(from, to));
    add(line, curve_->at(from), 0);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
      const bool back = to < from;
      const double a = back ? ends[ends.size() - 1 - k] : ends[k],
                   b = back ? ends[ends.size() - 2 - k] : ends[k + 1];
      divide(line, a, b);
    }
    add(line, end, 0);
    return line;
  }

 private:
  static void add(BoundaryLine& line, const Parameters& p, double off) {
    if (p == line.points.back()) return;
    line.points.push_back(p);
    line.off.push_back(off);
  }

  void divide(BoundaryLine& line, double a, double b) {
    constexpr double most = 64;
    const double bending = curve_->bending(std::min(a, b), std::max(a, b));
    const double sagitta = 0.125 * (b - a) * (b - a) * bending;
    const DerivativeBounds first =
        patches_.derivative_bounds(box_around(curve_->at(a), curve_->at(b), sagitta));
    const double off = (first.u + first.v) * sagitta;
    const double pieces = std::clamp(std::ceil(std::sqrt(off / fine_)), 1.0, most);
    for (double k = 1; k <= pieces; ++k) {
      const double t = k == pieces ? b : a + (b - a) * (k / pieces);
      const Parameters p = curve_->at(t);
      add(line, p, off / (pieces * pieces));
      measure(line, p, t);
    }
  }

  void measure(BoundaryLine& line, const Parameters& p, double t) const {
    if (in_space_.IsNull()) return;
    const double share = last_ > first_ ? (t - first_) / (last_ - first_) : 0;
    const double gap = distance_from_curve(patches_.point_at(p),
                                           first_in_space_ + share * (last_in_space_ - first_in_space_));
    line.tolerance = std::max(line.tolerance, gap);
  }

  /// From a point of the edge's curve in space, so no less than the distance from that curve: the nearest of
  /// some, by Newton's method from the same parameter, which need not be the nearest where the two curves are
  /// passed at different speeds.
  double distance_from_curve(const Vector<3>& p, double t) const {
    constexpr int most = 8;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most; ++k) {
      gp_Pnt q;
      gp_Vec along;
      in_space_->D1(t, q, along);
      const Vector<3> off = p - Vector<3>(q.X(), q.Y(), q.Z());
      if (!(off.norm() < least)) break;
      least = off.norm();
      const double squared = along.SquareMagnitude();
      if (least <= tolerance_ || !(squared > 0)) break;
      t += off.dot(Vector<3>(along.X(), along.Y(), along.Z())) / squared;
      t = std::clamp(t, first_in_space_, last_in_space_);
    }
    return least;
  }

  FacePatches& patches_;
  double fine_, tolerance_;
  std::optional<EdgeCurve> curve_;
  handle<Geom_Curve> in_space_;
  double first_ = 0, last_ = 0, first_in_space_ = 0, last_in_space_ = 0;
};

double tolerance_of(const TopoDS_Vertex& vertex) {
  return vertex.IsNull() ? 0 : BRep_Tool::Tolerance(vertex);
}

}  // namespace

Boundary boundary_of(const TopoDS_Face& face, const handle<Poly_Triangulation>& triangulation,
                     const TopLoc_Location& location, FacePatches& patches, double fine) {
  Boundary boundary;
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(at.Current());
    const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
    if (polygon.IsNull() || !polygon->HasParameters()) throw Standard_Failure("an edge is in no triangle");
    LineMaker maker(edge, face, patches, fine, polygon->Parameter(1),
                    triangulation->UVNode(polygon->Node(1)));
    const auto node_at = [&](int k) { return static_cast<std::uint32_t>(polygon->Node(k)) - 1; };
    const auto parameters_at = [&](int k) {
      const gp_Pnt2d p = triangulation->UVNode(polygon->Node(k));
      return Parameters{p.X(), p.Y()};
    };
    for (int k = 1; k < polygon->NbNodes(); ++k) {
      if (node_at(k) == node_at(k + 1)) continue;
      BoundaryLine line = maker.line(polygon->Parameter(k), polygon->Parameter(k + 1), parameters_at(k),
                                     parameters_at(k + 1));
      if (k == 1) line.tolerance_from = tolerance_of(TopExp::FirstVertex(edge));
      if (k + 2 > polygon->NbNodes()) line.tolerance_to = tolerance_of(TopExp::LastVertex(edge));
      const std::array<std::uint32_t, 2> nodes{node_at(k), node_at(k + 1)};
      // A slit is passed twice, and ends nothing.
      if (boundary.erase(nodes) + boundary.erase({nodes[1], nodes[0]}) == 0)
        boundary.emplace(nodes, std::move(line));
    }
  }
  return boundary;
}

void cut(Boundary& boundary, const std::array<std::uint32_t, 2>& edge, std::uint32_t node,
         const Parameters& at) {
  auto line = boundary.extract(edge);
  std::array<std::uint32_t, 2> nodes = edge;
  if (line.empty()) {
    std::swap(nodes[0], nodes[1]);
    line = boundary.extract(nodes);
  }
  if (line.empty()) throw Standard_Failure("a pole is no edge of it");
  const BoundaryLine& whole = line.mapped();
  const auto length_of = [&](std::size_t k) {
    return std::hypot(whole.points[k + 1][0] - whole.points[k][0],
                      whole.points[k + 1][1] - whole.points[k][1]);
  };
  std::size_t longest = 0;  // the others are roundoffs
  for (std::size_t k = 0; k < whole.off.size(); ++k)
    if (length_of(k) > length_of(longest)) longest = k;
  const auto end = static_cast<std::ptrdiff_t>(longest) + 1;
  BoundaryLine first = whole, second = whole;
  first.points.erase(first.points.begin() + end, first.points.end());
  first.points.push_back(at);
  first.off.resize(longest + 1);
  first.tolerance_to = second.tolerance_from = 0;
  second.points.erase(second.points.begin(), second.points.begin() + end);
  second.points.insert(second.points.begin(), at);
  second.off.erase(second.off.begin(), second.off.begin() + end - 1);
  boundary.emplace(std::array{nodes[0], node}, std::move(first));
  boundary.emplace(std::array{node, nodes[1]}, std::move(second));
}

}  // namespace bernal::cad
