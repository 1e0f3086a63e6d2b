#include "meshes/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace bernal {
namespace {

__extension__ using Wide = __int128;
using Whole = std::array<std::int64_t, 3>;

int sign_of(Wide x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// The sign of the determinant of three differences of at most 41 bits.
int determinant_sign(const Whole& a, const Whole& b, const Whole& c) {
  const auto d = [](std::int64_t x) { return static_cast<double>(x); };
  const double m0 = d(b[1]) * d(c[2]), m1 = d(b[2]) * d(c[1]), m2 = d(b[2]) * d(c[0]), m3 = d(b[0]) * d(c[2]),
               m4 = d(b[0]) * d(c[1]), m5 = d(b[1]) * d(c[0]);
  const double value = d(a[0]) * (m0 - m1) + d(a[1]) * (m2 - m3) + d(a[2]) * (m4 - m5);
  const double sum = std::abs(d(a[0])) * (std::abs(m0) + std::abs(m1)) +
                     std::abs(d(a[1])) * (std::abs(m2) + std::abs(m3)) +
                     std::abs(d(a[2])) * (std::abs(m4) + std::abs(m5));
  constexpr double rounding = 1e-15;
  if (value > rounding * sum) return 1;
  if (value < -rounding * sum) return -1;
  const Wide exact = Wide{a[0]} * (Wide{b[1]} * c[2] - Wide{b[2]} * c[1]) +
                     Wide{a[1]} * (Wide{b[2]} * c[0] - Wide{b[0]} * c[2]) +
                     Wide{a[2]} * (Wide{b[0]} * c[1] - Wide{b[1]} * c[0]);
  return sign_of(exact);
}

Whole difference(const Whole& a, const Whole& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

int orientation_in_plane(const Whole& a, const Whole& b, const Whole& p) {
  return sign_of(Wide{b[0] - a[0]} * (p[1] - a[1]) - Wide{b[1] - a[1]} * (p[0] - a[0]));
}

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

}  // namespace

Delaunay::Delaunay(Surface surface, double extent) : surface_(surface), extent_(extent) {}

Delaunay::Whole Delaunay::on_grid(const Vector<3>& p) const {
  constexpr double cells = 274877906944.0;  // 2^38
  const Vector<3> q = p / extent_;
  const auto whole = [](double x) { return static_cast<std::int64_t>(std::nearbyint(x * cells)); };
  return {whole(q[0]), whole(q[1]),
          surface_ == Surface::sphere ? whole(q[2]) : whole(-q[0] * q[0] - q[1] * q[1])};
}

bool Delaunay::is_left(std::uint32_t a, std::uint32_t b, const Whole& p) const {
  return surface_ == Surface::sphere ? determinant_sign(whole_[a], whole_[b], p) > 0
                                     : orientation_in_plane(whole_[a], whole_[b], p) > 0;
}

int Delaunay::side_of(std::uint32_t a, std::uint32_t b, std::uint32_t point) const {
  return orientation_in_plane(whole_[a], whole_[b], whole_[point]);
}

bool Delaunay::sees(const Face& f, const Whole& p) const {
  for (std::size_t k = 0; k < 3; ++k)
    if (f.corners[k] == beyond) {
      const Whole &u = whole_[f.corners[(k + 1) % 3]], &v = whole_[f.corners[(k + 2) % 3]];
      const int side = orientation_in_plane(u, v, p);
      if (side != 0) return side > 0;
      const Wide along = Wide{p[0] - u[0]} * (v[0] - p[0]) + Wide{p[1] - u[1]} * (v[1] - p[1]);
      return along > 0;
    }
  const Whole& a = whole_[f.corners[0]];
  return determinant_sign(difference(whole_[f.corners[1]], a), difference(whole_[f.corners[2]], a),
                          difference(p, a)) > 0;
}

std::uint32_t Delaunay::add_face(const Face& f) {
  if (!dead_.empty()) {
    const std::uint32_t at = dead_.back();
    dead_.pop_back();
    const std::uint32_t stamp = faces_[at].stamp;
    faces_[at] = f;
    faces_[at].stamp = stamp + 1;
    return at;
  }
  faces_.push_back(f);
  return static_cast<std::uint32_t>(faces_.size() - 1);
}

bool Delaunay::make_first(std::span<const Vector<3>> points, std::array<std::size_t, 4>& used) {
  const std::size_t n = points.size();
  std::vector<Whole> w;
  w.reserve(n);
  for (const Vector<3>& p : points) w.push_back(on_grid(p));
  // Points far from each other, so that the first faces are large.
  const auto farthest = [&](const auto& measure) {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t k = 0; k < n; ++k)
      if (const double m = measure(points[k]); m > most) {
        most = m;
        best = k;
      }
    return best;
  };
  const Vector<3> a = points[0];
  const std::size_t second = farthest([&](const Vector<3>& p) { return (p - a).squaredNorm(); });
  const Vector<3> ab = points[second] - a;
  const std::size_t third = farthest([&](const Vector<3>& p) { return (p - a).cross(ab).squaredNorm(); });
  used = {0, second, third, n};
  const bool on_sphere = surface_ == Surface::sphere;
  bool turned = false;
  if (on_sphere) {
    const Vector<3> normal = ab.cross(points[third] - a);
    const std::size_t fourth = farthest([&](const Vector<3>& p) { return std::abs((p - a).dot(normal)); });
    used[3] = fourth;
    const int side = determinant_sign(difference(w[second], w[0]), difference(w[third], w[0]),
                                      difference(w[fourth], w[0]));
    if (side == 0) return false;
    turned = side > 0;  // the fourth must lie behind the first face
  } else {
    const int side = orientation_in_plane(w[0], w[second], w[third]);
    if (side == 0) return false;
    turned = side < 0;
  }
  if (turned) std::swap(used[1], used[2]);
  points_.clear();
  for (const Vector<3>& p : points) points_.push_back(p);
  whole_ = std::move(w);
  const auto v = [&](std::size_t k) {
    return k == 3 && !on_sphere ? beyond : static_cast<std::uint32_t>(used[k]);
  };
  const std::array<std::array<std::size_t, 3>, 4> corners = {{{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}}};
  for (const auto& c : corners) add_face({{v(c[0]), v(c[1]), v(c[2])}, {none, none, none}, {}});
  for (std::uint32_t f = 0; f < 4; ++f)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::uint32_t g = 0; g < 4; ++g)
        for (std::size_t l = 0; l < 3; ++l)
          if (faces_[f].corners[k] == faces_[g].corners[(l + 1) % 3] &&
              faces_[f].corners[(k + 1) % 3] == faces_[g].corners[l])
            faces_[f].beside[k] = g;
  return true;
}

bool Delaunay::begin(std::span<const Vector<3>> points) {
  std::array<std::size_t, 4> used{};
  if (points.size() < 3 || !make_first(points, used)) return false;
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    if (std::ranges::find(used, std::size_t{k}) != used.end()) continue;
    const std::uint32_t from = locate(points[k], last_);
    if (from == none || !find_cavity(points[k], from)) return false;
    fill_cavity(points[k], k);
  }
  return true;
}

std::uint32_t Delaunay::locate(const Vector<3>& point, std::uint32_t from) const {
  const Whole p = on_grid(point);
  std::uint32_t at = from < faces_.size() && faces_[from].is_alive ? from : none;
  if (at == none)
    for (std::uint32_t f = 0; f < faces_.size() && at == none; ++f)
      if (faces_[f].is_alive) at = f;
  const std::size_t most = 40 + 4 * static_cast<std::size_t>(std::sqrt(static_cast<double>(faces_.size())));
  std::size_t turn = 0;
  for (std::size_t step = 0; step < most && at != none; ++step) {
    const Face& f = faces_[at];
    if (sees(f, p)) return at;
    if (!is_finite(f)) {  // back into the hull
      for (std::size_t k = 0; k < 3; ++k)
        if (f.corners[k] == beyond) at = f.beside[(k + 1) % 3];
      continue;
    }
    std::uint32_t next = none;
    for (std::size_t s = 0; s < 3 && next == none; ++s) {
      const std::size_t k = (s + turn) % 3;
      if (is_left(f.corners[(k + 1) % 3], f.corners[k], p)) next = f.beside[k];
    }
    ++turn;
    at = next;
  }
  for (std::uint32_t f = 0; f < faces_.size(); ++f)
    if (faces_[f].is_alive && sees(faces_[f], p)) return f;
  return none;
}

bool Delaunay::find_cavity(const Vector<3>& point, std::uint32_t from) {
  const Whole p = on_grid(point);
  cavity_.clear();
  rim_.clear();
  if (from == none || !faces_[from].is_alive || !sees(faces_[from], p)) return false;
  const auto is_in = [&](std::uint32_t f) { return std::ranges::find(cavity_, f) != cavity_.end(); };
  cavity_.push_back(from);
  for (std::size_t m = 0; m < cavity_.size(); ++m) {
    const Face& f = faces_[cavity_[m]];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t beside = f.beside[k];
      if (!f.bound[k] && is_in(beside)) continue;
      if (!f.bound[k] && sees(faces_[beside], p)) {
        cavity_.push_back(beside);
      } else {
        rim_.push_back({f.corners[k], f.corners[(k + 1) % 3], beside, f.bound[k]});
      }
    }
  }
  return true;
}

bool Delaunay::runs_counterclockwise(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) const {
  return surface_ == Surface::sphere ? a.dot(b.cross(c)) > 0
                                     : (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
}

bool Delaunay::is_star_shaped(const Vector<3>& point) const {
  return std::ranges::all_of(rim_, [&](const RimEdge& e) {
    return e.from == beyond || e.to == beyond || runs_counterclockwise(points_[e.from], points_[e.to], point);
  });
}

std::uint32_t Delaunay::fill_cavity(const Vector<3>& point, std::uint32_t as) {
  const std::uint32_t p = as == none ? static_cast<std::uint32_t>(points_.size()) : as;
  if (as == none) {
    points_.push_back(point);
    whole_.push_back(on_grid(point));
  }
  for (const std::uint32_t f : cavity_) {
    faces_[f].is_alive = false;
    dead_.push_back(f);
  }
  fresh_.clear();
  for (const RimEdge& e : rim_) {
    const std::uint32_t f = add_face({{e.from, e.to, p}, {e.outside, none, none}, {e.bound, false, false}});
    fresh_.push_back(f);
    Face& outside = faces_[e.outside];
    for (std::size_t k = 0; k < 3; ++k)
      if (outside.corners[k] == e.to && outside.corners[(k + 1) % 3] == e.from) outside.beside[k] = f;
  }
  for (const std::uint32_t f : fresh_)
    for (const std::uint32_t g : fresh_)
      if (faces_[f].corners[1] == faces_[g].corners[0]) {
        faces_[f].beside[1] = g;
        faces_[g].beside[2] = f;
      }
  last_ = fresh_.front();
  return p;
}

bool Delaunay::bind(std::span<const std::array<std::uint32_t, 2>> edges) {
  std::unordered_set<std::uint64_t> keys;
  for (const auto& [a, b] : edges) keys.insert(key_of(a, b));
  std::size_t found = 0;
  for (Face& f : faces_) {
    if (!f.is_alive) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f.corners[k], b = f.corners[(k + 1) % 3];
      if (a == beyond || b == beyond || !keys.contains(key_of(a, b))) continue;
      f.bound[k] = true;
      ++found;
    }
  }
  return found == 2 * keys.size();
}

void Delaunay::move(std::uint32_t point, const Vector<3>& to) {
  points_[point] = to;
  whole_[point] = on_grid(to);
}

/// Whether the two triangles at an edge make a quadrilateral that the other diagonal may divide.
bool Delaunay::is_convex_about(std::uint32_t face, std::size_t edge) const {
  const Face &f = faces_[face], &g = faces_[f.beside[edge]];
  if (!is_finite(f) || !is_finite(g)) return false;
  const std::uint32_t a = f.corners[edge], b = f.corners[(edge + 1) % 3], c = f.corners[(edge + 2) % 3];
  std::uint32_t d = g.corners[0];
  for (const std::uint32_t corner : g.corners)
    if (corner != a && corner != b) d = corner;
  return runs_counterclockwise(points_[a], points_[d], points_[c]) &&
         runs_counterclockwise(points_[d], points_[b], points_[c]);
}

bool Delaunay::flip(std::uint32_t face, std::size_t edge) {
  const Face& f = faces_[face];
  if (f.bound[edge] || !is_convex_about(face, edge)) return false;
  std::uint32_t d = f.corners[0];
  for (const std::uint32_t corner : faces_[f.beside[edge]].corners)
    if (corner != f.corners[edge] && corner != f.corners[(edge + 1) % 3]) d = corner;
  if (!sees(f, whole_[d])) return false;
  swap_diagonal(face, edge);
  return true;
}

/// Precondition: `is_convex_about`.
void Delaunay::swap_diagonal(std::uint32_t face, std::size_t edge) {
  Face& f = faces_[face];
  const std::uint32_t other = f.beside[edge];
  Face& g = faces_[other];
  std::size_t l = 0;
  while (g.beside[l] != face || g.corners[l] != f.corners[(edge + 1) % 3]) ++l;
  const std::size_t k1 = (edge + 1) % 3, k2 = (edge + 2) % 3, l1 = (l + 1) % 3, l2 = (l + 2) % 3;
  const std::uint32_t a = f.corners[edge], b = f.corners[k1], c = f.corners[k2], d = g.corners[l2];
  const Face before_f = f, before_g = g;
  f.corners = {a, d, c};
  f.beside = {before_g.beside[l1], other, before_f.beside[k2]};
  f.bound = {before_g.bound[l1], false, before_f.bound[k2]};
  g.corners = {d, b, c};
  g.beside = {before_g.beside[l2], before_f.beside[k1], face};
  g.bound = {before_g.bound[l2], before_f.bound[k1], false};
  const auto relink = [&](std::uint32_t at, std::uint32_t from, std::uint32_t to, std::uint32_t now) {
    Face& h = faces_[at];
    for (std::size_t k = 0; k < 3; ++k)
      if (h.corners[k] == to && h.corners[(k + 1) % 3] == from) h.beside[k] = now;
  };
  relink(f.beside[0], a, d, face);
  relink(g.beside[1], b, c, other);
  ++f.stamp;
  ++g.stamp;
}

void Delaunay::restore() {
  std::vector<std::uint32_t> open;
  for (std::uint32_t f = 0; f < faces_.size(); ++f)
    if (faces_[f].is_alive) open.push_back(f);
  std::size_t most = 20 * open.size();
  while (!open.empty() && most-- > 0) {
    const std::uint32_t f = open.back();
    open.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t other = faces_[f].beside[k];
      if (!flip(f, k)) continue;
      open.push_back(f);
      open.push_back(other);
      break;
    }
  }
}

Vector<3> Delaunay::circumcenter(const Face& f) const {
  const Vector<3>&a = points_[f.corners[0]], &b = points_[f.corners[1]], &c = points_[f.corners[2]];
  if (surface_ == Surface::sphere) return extent_ * (b - a).cross(c - a).normalized();
  const Vector<3> u = b - a, v = c - a;
  const double twice = 2 * (u[0] * v[1] - u[1] * v[0]), uu = u.squaredNorm(), vv = v.squaredNorm();
  return a + Vector<3>(v[1] * uu - u[1] * vv, u[0] * vv - v[0] * uu, 0) / twice;
}

double Delaunay::circumradius(const Face& f) const {
  const Vector<3>&a = points_[f.corners[0]], &b = points_[f.corners[1]], &c = points_[f.corners[2]];
  return (b - a).norm() * (c - b).norm() * (a - c).norm() / (2 * (b - a).cross(c - a).norm());
}

}  // namespace bernal
