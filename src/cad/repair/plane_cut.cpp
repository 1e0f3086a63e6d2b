#include "cad/repair/plane_cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_map.hpp>
#include <charconv>
#include <cmath>

#include "bernal/core/error.hpp"
#include "cad/read/triangulate.hpp"
#include "geometry/changes.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

[[noreturn]] void refuse_text(std::string_view text) {
  throw Error(
      ErrorCode::bad_argument,
      fmt::format("\"{:.60}\" is no plane; write \"z = 1.1\", \"x < 0.5\" or \"0.6 x + 0.8 z = 2\"", text));
}

/// Reads a sum of terms "2", "x", "-0.5 y", "3*z"; bare numbers are added to `constant`.
void read_sum(std::string_view sum, std::string_view whole, Vector<3>& factors, double& constant) {
  std::size_t at = 0, terms = 0;
  const auto skip = [&] {
    while (at < sum.size() && (sum[at] == ' ' || sum[at] == '\t')) ++at;
  };
  for (skip(); at < sum.size(); skip(), ++terms) {
    double factor = 1;
    if (sum[at] == '+' || sum[at] == '-') {
      factor = sum[at++] == '-' ? -1 : 1;
      skip();
    } else if (terms > 0) {
      refuse_text(whole);
    }
    double value = 1;
    const char* begin = sum.data() + at;
    const auto [end, error] = std::from_chars(begin, sum.data() + sum.size(), value);
    const bool has_number = error == std::errc() && std::isfinite(value);
    if (has_number) {
      at += static_cast<std::size_t>(end - begin);
      skip();
      if (at < sum.size() && sum[at] == '*') {
        ++at;
        skip();
      }
    }
    factor *= has_number ? value : 1;
    if (at < sum.size() && sum[at] >= 'x' && sum[at] <= 'z')
      factors[sum[at++] - 'x'] += factor;
    else if (has_number)
      constant += factor;
    else
      refuse_text(whole);
  }
  if (terms == 0) refuse_text(whole);
}

/// The triangles on the plane's side, cut where needed; corners on the plane stay in place.
class Cutter {
 public:
  Cutter(const Mesh& mesh, const CutPlane& plane, double tolerance) : plane_(plane) {
    result.vertices = mesh.vertices;
    const double slack = tolerance * plane.normal.norm();
    for (const Vector<3>& v : mesh.vertices) {
      const double h = plane.height(v);
      side_.push_back(std::abs(h) <= slack ? 0 : h < 0 ? -1 : 1);
    }
    for (const FaceCorners& t : mesh.triangles) take(t);
  }

  bool is_on_plane(std::uint32_t v) const { return side_[v] == 0; }

  Mesh result;
  std::size_t removed = 0;  ///< triangles of which a part was removed

 private:
  void take(const FaceCorners& t) {
    const auto count = [&](int side) {
      return std::ranges::count_if(t, [&](std::uint32_t v) { return side_[v] == side; });
    };
    if (count(1) > 0) ++removed;
    if (count(-1) == 0) return;  // above the plane, or in it, where the lid goes
    if (count(1) == 0) {
      result.triangles.push_back(t);
      return;
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (side_[a] <= 0) corners.push_back(a);
      if (side_[a] * side_[b] < 0) corners.push_back(crossing(a, b));
    }
    for (std::size_t k = 2; k < corners.size(); ++k)
      result.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }

  /// The corner where an edge crosses the plane; the same for both of its faces.
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b) {
    const Edge edge = std::minmax(a, b);
    const auto [entry, is_new] = crossings_.try_emplace(edge, static_cast<std::uint32_t>(side_.size()));
    if (!is_new) return entry->second;
    const Vector<3> p = result.vertices[edge.first], q = result.vertices[edge.second];
    const double hp = plane_.height(p), hq = plane_.height(q);
    Vector<3> x = p + hp / (hp - hq) * (q - p);
    for (int k = 0; k < 3; ++k)  // exact for a plane normal to an axis
      if (std::abs(plane_.normal[k]) == plane_.normal.norm()) x[k] = plane_.offset / plane_.normal[k];
    result.vertices.push_back(x);
    side_.push_back(0);
    return entry->second;
  }

  const CutPlane& plane_;
  std::vector<int> side_;
  boost::unordered_map<Edge, std::uint32_t> crossings_;
};

/// The open edges that lie in the plane.
std::vector<Edge> rim_of(const Cutter& cutter) {
  std::vector<Edge> rim;
  for (const EdgeUse& edge : open_edges(cutter.result.triangles))
    if (cutter.is_on_plane(edge.low) && cutter.is_on_plane(edge.high)) rim.emplace_back(edge.low, edge.high);
  return rim;
}

}  // namespace

CutPlane CutPlane::turned() const {
  CutPlane other = *this;
  other.normal = -normal;
  other.offset = -offset;
  return other;
}

CutPlane plane_in(std::string_view text) {
  const std::size_t sign = text.find_first_of("=<>");
  if (sign == std::string_view::npos) refuse_text(text);
  std::size_t right = sign + 1;
  if (text[sign] != '=' && right < text.size() && text[right] == '=') ++right;  // <= means the same as <
  CutPlane plane;
  plane.text = text;
  plane.side_is_open = text[sign] == '=';
  plane.normal.setZero();
  Vector<3> on_the_right = Vector<3>::Zero();
  double left_constant = 0, right_constant = 0;
  read_sum(text.substr(0, sign), text, plane.normal, left_constant);
  read_sum(text.substr(right), text, on_the_right, right_constant);
  plane.normal -= on_the_right;
  plane.offset = right_constant - left_constant;
  if (plane.normal.isZero(0) || !plane.normal.allFinite() || !std::isfinite(plane.offset)) refuse_text(text);
  // Scales to unit length without overflow or underflow, as for 1e200 x + 1e200 y.
  const double largest = plane.normal.cwiseAbs().maxCoeff();
  plane.normal /= largest;
  plane.offset /= largest;
  const double length = plane.normal.norm();
  plane.normal /= length;
  plane.offset /= length;
  if (!std::isfinite(plane.offset)) refuse_text(text);
  return text[sign] == '>' ? plane.turned() : plane;
}

Mesh cut(const Mesh& mesh, const CutPlane& plane, double tolerance) {
  const auto refuse = [&](const char* why) {
    throw Error(ErrorCode::bad_mesh, fmt::format("the plane \"{}\" {}", plane.text, why));
  };
  Cutter cutter(mesh, plane, tolerance);
  if (cutter.result.triangles.empty()) refuse("leaves nothing of the surface");
  if (cutter.removed == 0 && topology_of(mesh).closed()) return mesh;  // all of it is on that side
  const std::vector<Edge> rim = rim_of(cutter);
  const bool passes_between = rim.empty() && cutter.removed > 0 && topology_of(cutter.result).closed();
  if (rim.empty() && !passes_between)
    refuse(cutter.removed == 0 ? "meets no surface" : "leaves nothing open to be closed");

  Mesh result = std::move(cutter.result);
  if (!passes_between) {
    const auto lid = triangulate_regions(result.vertices, rim, plane.normal);
    if (!lid) refuse("cuts the surface in a line that crosses itself or does not close");
    result.triangles.insert(result.triangles.end(), lid->begin(), lid->end());
  }
  drop_unused_vertices(result);
  return result;
}

}  // namespace bernal::cad
