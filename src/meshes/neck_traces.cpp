// Where ends of periods cut the sides of necks: curves on cylinders, whose ends are on the circles where
// necks begin or on edges of the box.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

using std::numbers::pi;

/// A part of the curve in which a plane cuts the side of a neck: t from 0 to 1.
struct TraceCurve {
  std::function<Vector<3>(double)> at;
  bool is_closed = false;
};

/// The curves in which the plane x[axis] = level cuts the side. The angle about the axis is counted from
/// where the side rises most towards the plane's normal: there height·u + a·sin·cos(angle) = level.
std::vector<TraceCurve> curves_of(const DraftNeck& neck, int axis, double level) {
  const double v = neck.across[axis], w = neck.around()[axis], u = neck.axis[axis];
  const double rise = neck.radius * std::hypot(v, w), turn = std::atan2(w, v), d = level - neck.center[axis];
  const auto point = [=, &neck](double angle, double height) {
    Vector<3> p =
        neck.center + height * neck.axis +
        neck.radius * (std::cos(angle + turn) * neck.across + std::sin(angle + turn) * neck.around());
    p[axis] = level;
    return p;
  };
  const double first = (d - neck.begin * u) / rise, last = (d - neck.end * u) / rise;  // cosines at the rims
  const double most = std::max(first, last), least = std::min(first, last);
  if (!(most > -1 && least < 1)) return {};
  const auto on_plane = [=, &neck](double angle) {
    return point(angle, std::clamp((d - rise * std::cos(angle)) / u, neck.begin, neck.end));
  };
  std::vector<TraceCurve> curves;
  if (most < 1 && least > -1) {  // two curves from rim to rim
    for (const double side : {1.0, -1.0})
      curves.push_back({[=, &neck](double t) {
        const double height = neck.begin + t * (neck.end - neck.begin);
        return point(side * std::acos(std::clamp((d - height * u) / rise, -1.0, 1.0)), height);
      }});
  } else if (most < 1) {  // from a rim around the lowest place back to it
    const double from = std::acos(most);
    curves.push_back({[=](double t) { return on_plane(from + t * (2 * pi - 2 * from)); }});
  } else if (least > -1) {
    const double to = std::acos(least);
    curves.push_back({[=](double t) { return on_plane((2 * t - 1) * to); }});
  } else {
    curves.push_back({[=](double t) { return on_plane(2 * pi * t); }, true});
  }
  return curves;
}

class NeckTraces {
 public:
  explicit NeckTraces(SurfaceDraft& draft) : draft_(draft) {}

  void make() {
    for (std::uint32_t n = 0; n < draft_.necks.size(); ++n)
      if (draft_.necks[n].is_cut) numbers_[{draft_.necks[n].bond, draft_.necks[n].image}] = n;
    for (const auto& [key, n] : numbers_)
      for (int k = 0; k < 3; ++k)
        if (draft_.boundary.repeats(k)) make_lower(n, k);
    for (const auto& [key, n] : numbers_)
      for (int k = 0; k < 3; ++k)
        if (draft_.boundary.repeats(k)) lift(n, k);
  }

 private:
  double end_at(int axis, bool upper) const {
    return draft_.boundary.origin[axis] + (upper ? draft_.boundary.edges[axis] : 0);
  }
  std::uint32_t before(std::uint32_t n, int axis) const {
    auto image = draft_.necks[n].image;
    --image[static_cast<std::size_t>(axis)];
    const auto found = numbers_.find({draft_.necks[n].bond, image});
    return found == numbers_.end() ? Delaunay::none : found->second;
  }

  bool is_inside(const Vector<3>& p, int but) const {
    for (int j = 0; j < 3; ++j)
      if (j != but && draft_.boundary.repeats(j) && !(p[j] > end_at(j, false) && p[j] < end_at(j, true)))
        return false;
    return true;
  }

  void make_lower(std::uint32_t n, int axis) {
    const DraftNeck neck = draft_.necks[n];
    for (const TraceCurve& curve : curves_of(neck, axis, end_at(axis, false))) {
      // Where it passes other ends.
      std::vector<std::pair<double, int>> stops;
      constexpr int samples = 200;
      for (int j = 0; j < 3; ++j) {
        if (j == axis || !draft_.boundary.repeats(j)) continue;
        for (const bool upper : {false, true}) {
          const auto beyond = [&](double t) { return curve.at(t)[j] > end_at(j, upper); };
          for (int s = 0; s < samples; ++s) {
            double from = static_cast<double>(s) / samples, to = static_cast<double>(s + 1) / samples;
            const bool is_beyond = beyond(from);
            if (is_beyond == beyond(to)) continue;
            for (int round = 0; round < 50; ++round) {
              const double middle = 0.5 * (from + to);
              (beyond(middle) == is_beyond ? from : to) = middle;
            }
            stops.push_back({0.5 * (from + to), 2 * j + upper});
          }
        }
      }
      std::ranges::sort(stops);
      if (stops.empty()) {
        if (is_inside(curve.at(0.5), axis)) add(n, axis, curve, {0, -1}, {1, -1});
        continue;
      }
      std::vector<std::pair<double, int>> all = stops;
      if (curve.is_closed) {
        all.push_back({stops.front().first + 1, stops.front().second});
      } else {
        all.insert(all.begin(), {0, -1});
        all.push_back({1, -1});
      }
      for (std::size_t s = 0; s + 1 < all.size(); ++s) {
        const double middle = 0.5 * (all[s].first + all[s + 1].first);
        if (is_inside(curve.at(middle), axis)) add(n, axis, curve, all[s], all[s + 1]);
      }
    }
  }

  /// Vertices along a part of a curve, from stop to stop: a place and the end of another period there, or -1
  /// where a rim is.
  void add(std::uint32_t n, int axis, const TraceCurve& curve, const std::pair<double, int>& from,
           const std::pair<double, int>& to) {
    NeckTrace trace;
    trace.face = 2 * axis;
    trace.is_closed = curve.is_closed && from.second < 0;
    const double edge = draft_.necks[n].edge;
    constexpr int samples = 64;
    std::vector<double> length = {0};
    const auto place = [&](double share) { return from.first + share * (to.first - from.first); };
    for (int s = 0; s < samples; ++s)
      length.push_back(length.back() + (curve.at(place(static_cast<double>(s + 1) / samples)) -
                                        curve.at(place(static_cast<double>(s) / samples)))
                                           .norm());
    const auto vertex_near = [&](const std::pair<double, int>& stop) {
      const Vector<3> p = curve.at(stop.first);
      return stop.second < 0 ? on_rim(n, axis, p) : on_line(n, 2 * axis, stop.second, p);
    };
    trace.ids.push_back(trace.is_closed ? draft_.vertex_at(curve.at(0), edge) : vertex_near(from));
    const int count =
        std::max(trace.is_closed ? 6 : 1, static_cast<int>(std::ceil(length.back() / edge)));
    std::size_t s = 0;
    for (int k = 1; k < count; ++k) {
      const double wanted = length.back() * k / count;
      while (length[s + 1] < wanted) ++s;
      const double share =
          (static_cast<double>(s) + (wanted - length[s]) / (length[s + 1] - length[s])) / samples;
      trace.ids.push_back(draft_.vertex_at(curve.at(place(share)), edge));
    }
    if (!trace.is_closed) trace.ids.push_back(vertex_near(to));
    draft_.necks[n].traces.push_back(trace);
  }

  /// The vertex of a rim on the lower end of an axis that is nearest.
  std::uint32_t on_rim(std::uint32_t n, int axis, const Vector<3>& p) const {
    const DraftNeck& neck = draft_.necks[n];
    std::uint32_t found = Delaunay::none;
    double nearest = 1e-6 * neck.radius;
    for (std::size_t e = 0; e < 2; ++e) {
      if (neck.pieces[e] == Delaunay::none) continue;
      const Circle& circle = draft_.pieces[neck.pieces[e]].circles[neck.circles[e]];
      if (circle.is_whole) continue;
      for (const auto& chain : circle.chains)
        for (const std::uint32_t id : {chain.front(), chain.back()}) {
          const Vector<3>& q = draft_.made.vertices[id];
          if (q[axis] != end_at(axis, false) || (q - p).norm() >= nearest) continue;
          nearest = (q - p).norm();
          found = id;
        }
    }
    if (found == Delaunay::none)
      throw Error(ErrorCode::bad_argument,
                  "an end of a period nearly touches a bridge; another radius of bridges makes room");
    return found;
  }

  /// The vertex in which the line of two ends meets the side, near p.
  std::uint32_t on_line(std::uint32_t n, int face, int other, const Vector<3>& p) {
    for (const int of : {face, other}) {
      if (of % 2 == 0) continue;
      const int axis = of / 2;
      const std::uint32_t lower = before(n, axis);
      if (lower == Delaunay::none)
        throw Error(ErrorCode::bad_argument,
                    "an edge of the box nearly touches a bridge; another radius of bridges makes room");
      return draft_.lifted(axis, on_line(lower, of == face ? face - 1 : face, of == other ? other - 1 : other,
                                         p - draft_.boundary.edges[axis] * Vector<3>::Unit(axis)));
    }
    const DraftNeck& neck = draft_.necks[n];
    const int k = face / 2, j = other / 2, m = 3 - k - j;
    // |q - (q·u) u|² = a² along the line.
    Vector<3> at = Vector<3>::Zero();
    at[std::min(k, j)] = end_at(std::min(k, j), false);
    at[std::max(k, j)] = end_at(std::max(k, j), false);
    at[m] = neck.center[m];
    const Vector<3> from = at - neck.center, beside = from - from.dot(neck.axis) * neck.axis;
    const Vector<3> step = Vector<3>::Unit(m) - neck.axis[m] * neck.axis;
    const double aa = step.squaredNorm(), b = beside.dot(step),
                 c = beside.squaredNorm() - neck.radius * neck.radius;
    const double root = std::sqrt(std::max(0.0, b * b - aa * c));
    const std::array<double, 2> x = {at[m] + (-b - root) / aa, at[m] + (-b + root) / aa};
    at[m] = std::abs(x[0] - p[m]) < std::abs(x[1] - p[m]) ? x[0] : x[1];
    return draft_.vertex_at(at, neck.edge);
  }

  void lift(std::uint32_t n, int axis) {
    const std::uint32_t lower = before(n, axis);
    if (lower == Delaunay::none) return;
    const std::vector<NeckTrace> given = draft_.necks[lower].traces;
    for (NeckTrace trace : given) {
      if (trace.face != 2 * axis) continue;
      ++trace.face;
      for (std::uint32_t& id : trace.ids) id = draft_.lifted(axis, id);
      draft_.necks[n].traces.push_back(trace);
    }
  }

  SurfaceDraft& draft_;
  std::map<std::pair<std::uint32_t, std::array<int, 3>>, std::uint32_t> numbers_;
};

}  // namespace

double clearance_of_ends(const Boundary<3>& boundary, const Vector<3>& center, double sphere_radius,
                         const Vector<3>& direction, double radius, double edge) {
  constexpr double least_sine = 0.6;      // of the angle in which circles cross
  constexpr double least_distance = 0.5;  // of circles that do not, in edges
  const double beta = std::asin(radius / sphere_radius);
  const auto in_edges = [&](double angle) { return angle * sphere_radius / (least_distance * edge); };
  double least = std::numeric_limits<double>::infinity();
  std::array<std::vector<double>, 3> levels;  // of planes that cut the sphere, from its centre
  for (int k = 0; k < 3; ++k) {
    if (!boundary.repeats(k)) continue;
    const double from = (center[k] - boundary.origin[k]) / boundary.edges[k];
    for (const double turn : {std::floor(from), std::floor(from) + 1}) {
      const double d = (turn - from) * boundary.edges[k];
      if (!(std::abs(d) < sphere_radius)) continue;
      levels[static_cast<std::size_t>(k)].push_back(d);
      const double alpha = std::acos(d / sphere_radius),
                   theta = std::acos(std::clamp(direction[k], -1.0, 1.0));
      // Apart from each other on both sides of the sphere, or one inside of the other.
      const double apart =
          std::max({theta - alpha - beta, alpha - theta - beta, theta + alpha + beta - 2 * pi});
      if (apart >= 0) {
        least = std::min(least, in_edges(apart));
      } else if (beta - alpha - theta >= 0 || beta - (pi - alpha) - (pi - theta) >= 0) {
        least = std::min(least, 0.5);
      } else {
        const double cosine =
            (std::cos(theta) - std::cos(alpha) * std::cos(beta)) / (std::sin(alpha) * std::sin(beta));
        least = std::min(least, std::sqrt(std::max(0.0, 1 - cosine * cosine)) / least_sine);
      }
    }
  }
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < k; ++j)
      for (const double x : levels[static_cast<std::size_t>(k)])
        for (const double y : levels[static_cast<std::size_t>(j)]) {
          const double squared = sphere_radius * sphere_radius - x * x - y * y;
          if (!(squared > 0)) continue;
          for (const double side : {-1.0, 1.0}) {
            Vector<3> p;
            p[k] = x;
            p[j] = y;
            p[3 - k - j] = side * std::sqrt(squared);
            const double theta = std::atan2(p.cross(direction).norm(), p.dot(direction));
            least = std::min(least, in_edges(std::abs(theta - beta)));
          }
        }
  return least;
}

void add_neck_traces(SurfaceDraft& draft) { NeckTraces(draft).make(); }

}  // namespace bernal
