#include "meshes/patch_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

/// Of the size at a place: a triangle's circumradius above which it is cut. Edges are between this and twice
/// as long, mostly half as long again.
constexpr double largest_circumradius = 0.58;
constexpr double least_sine = 0.4540;  // 27 degrees
/// No triangles are made smaller than that for their angles' sake, of the size at the place.
constexpr double smallest_for_angles = 0.02;

struct Waiting {
  double badness;
  std::uint32_t face, stamp;
  bool operator<(const Waiting& o) const {
    return badness != o.badness ? badness < o.badness : face > o.face;
  }
};

/// Of the angle opposite to the shortest edge, which is acute.
double tangent_of_least_angle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  return 2 * (b - a).cross(c - a).norm() / (ab + bc + ca - 2 * std::min({ab, bc, ca}));
}

class Mesher {
 public:
  explicit Mesher(const BoundedPart& patch)
      : patch_(patch), fixed_(patch.points.size()), delaunay_(patch.surface, patch.extent) {}

  PatchMesh made() {
    std::vector<Vector<3>> points = patch_.points;
    points.insert(points.end(), patch_.starts.begin(), patch_.starts.end());
    for (std::uint32_t k = 0; k < points.size(); ++k) base_.push_back(k);
    shift_.assign(points.size(), 0);
    bases_ = points.size();
    std::vector<std::array<std::uint32_t, 2>> edges = patch_.edges;
    if (patch_.period > 0) copy_strip(points, edges);
    if (!delaunay_.begin(points)) fail("points coincide");
    const bool is_plane = !on_sphere() && !(patch_.period > 0);
    if (is_plane ? !delaunay_.recover(edges) : !delaunay_.bind(edges))
      fail("an edge of the boundary is crossed");
    label();
    refine();
    smooth();
    return collected();
  }

 private:
  [[noreturn]] static void fail(const char* why) {
    throw Error(
        ErrorCode::bad_argument,
        std::string("circles where bridges, caps or ends of periods cut a sphere or wall nearly touch "
                    "each other (") +
            why +
            "); a smaller gap or narrower bridges keep them apart, or smaller edges resolve "
            "what is between");
  }
  bool on_sphere() const { return patch_.surface == Delaunay::Surface::sphere; }

  void copy_strip(std::vector<Vector<3>>& points, std::vector<std::array<std::uint32_t, 2>>& edges) {
    const std::size_t n = points.size();
    std::vector<std::array<std::uint32_t, 3>> image(n);
    for (std::uint32_t k = 0; k < n; ++k) image[k][1] = k;
    for (const int s : {-1, 1})
      for (std::uint32_t k = 0; k < n; ++k) {
        const Vector<3> p = points[k] + Vector<3>(s * patch_.period, 0, 0);
        auto& at = image[k][static_cast<std::size_t>(s + 1)];
        at = Delaunay::none;
        if (p[0] < -patch_.margin || p[0] > patch_.period + patch_.margin) continue;
        at = static_cast<std::uint32_t>(points.size());
        points.push_back(p);
        base_.push_back(k);
        shift_.push_back(s);
      }
    // An edge across the end of the period joins the nearest copies.
    const std::vector<std::array<std::uint32_t, 2>> given = edges;
    edges.clear();
    for (const auto& [a, b] : given) {
      const int turn = static_cast<int>(std::nearbyint((points[a][0] - points[b][0]) / patch_.period));
      for (int s = -1; s <= 1; ++s) {
        const int t = s + turn;
        if (t < -1 || t > 1) continue;
        const std::uint32_t u = image[a][static_cast<std::size_t>(s + 1)],
                            v = image[b][static_cast<std::size_t>(t + 1)];
        if (u != Delaunay::none && v != Delaunay::none) edges.push_back({u, v});
      }
    }
  }

  /// Of a strip all is inside but what lies in its circles, which may be cut by its ends.
  void label_strip() {
    std::vector<std::uint32_t> circle(bases_, Delaunay::none);
    for (std::uint32_t c = 0; c < patch_.circles.size(); ++c)
      for (const std::uint32_t p : patch_.circles[c]) circle[p] = c;
    const auto& faces = delaunay_.faces();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (!faces[f].is_alive || !delaunay_.is_finite(faces[f])) continue;
      const std::uint32_t a = circle[base_[faces[f].corners[0]]], b = circle[base_[faces[f].corners[1]]],
                          c = circle[base_[faces[f].corners[2]]];
      inside_[f] = !(a == b && b == c && a != Delaunay::none);
    }
  }

  /// In or out changes at each edge of the boundary.
  void label() {
    const auto& faces = delaunay_.faces();
    inside_.assign(faces.size(), 0);
    if (patch_.period > 0) return label_strip();
    std::vector<char> known(faces.size(), 0);
    std::vector<std::uint32_t> open;
    std::uint32_t start = 0;
    char first = 0;
    if (!on_sphere()) {
      while (!faces[start].is_alive || delaunay_.is_finite(faces[start])) ++start;
    } else if (patch_.circles.empty()) {
      first = 1;
      while (!faces[start].is_alive) ++start;
    } else {
      std::vector<char> on(delaunay_.points().size(), 0);
      for (const std::uint32_t p : patch_.circles.front()) on[p] = 1;
      const auto all_on = [&](const Delaunay::Face& f) {
        return on[f.corners[0]] && on[f.corners[1]] && on[f.corners[2]];
      };
      while (start < faces.size() && !(faces[start].is_alive && all_on(faces[start]))) ++start;
      if (start == faces.size()) fail("a circle is not free of points");
    }
    open.push_back(start);
    known[start] = 1;
    inside_[start] = first;
    for (std::size_t m = 0; m < open.size(); ++m)
      for (std::size_t k = 0; k < 3; ++k) {
        const Delaunay::Face& f = faces[open[m]];
        const char other = f.bound[k] ? !inside_[open[m]] : inside_[open[m]];
        if (known[f.beside[k]]) {
          if (inside_[f.beside[k]] != other) fail("its boundary is not closed");
          continue;
        }
        known[f.beside[k]] = 1;
        inside_[f.beside[k]] = other;
        open.push_back(f.beside[k]);
      }
  }

  double size_at(Vector<3> p) const {
    if (on_sphere()) p *= patch_.extent / p.norm();
    if (patch_.period > 0) p[0] -= patch_.period * std::floor(p[0] / patch_.period);
    return patch_.size(p);
  }

  /// Of the copies of a triangle in a strip the one that counts.
  bool is_own(const Delaunay::Face& f) const {
    if (!(patch_.period > 0)) return true;
    const std::uint32_t least = *std::ranges::min_element(
        f.corners, {}, [&](std::uint32_t c) { return std::pair(base_[c], shift_[c]); });
    return shift_[least] == 0;
  }

  void consider(std::uint32_t at) {
    const Delaunay::Face& f = delaunay_.faces()[at];
    if (!f.is_alive || !inside_[at] || !delaunay_.is_finite(f) || !is_own(f)) return;
    const auto& p = delaunay_.points();
    const Vector<3>&a = p[f.corners[0]], &b = p[f.corners[1]], &c = p[f.corners[2]];
    const double radius = delaunay_.circumradius(f), size = size_at((a + b + c) / 3);
    const double shortest =
        std::sqrt(std::min({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    if (radius > largest_circumradius * size || longest > size) {
      waiting_.push({1 + std::max(radius / (largest_circumradius * size), longest / size), at, f.stamp});
    } else if (shortest < 2 * radius * least_sine && radius > smallest_for_angles * size) {
      waiting_.push({std::min(1.0, 0.1 * radius / shortest), at, f.stamp});
    }
  }

  /// Whether the point would come near a bound edge of its cavity.
  bool encroaches(const Vector<3>& point) const {
    return std::ranges::any_of(delaunay_.rim(), [&](const Delaunay::RimEdge& e) {
      if (!e.bound) return false;
      const Vector<3> u = delaunay_.points()[e.from] - point, v = delaunay_.points()[e.to] - point;
      return u.dot(v) < 0;
    });
  }

  bool insert(const Vector<3>& point, std::uint32_t from, std::uint32_t base, int shift) {
    if (!delaunay_.find_cavity(point, from) || encroaches(point) || !delaunay_.is_star_shaped(point))
      return false;
    const char inside = inside_[from];
    if (shift == 0) base = static_cast<std::uint32_t>(bases_++);
    delaunay_.fill_cavity(point);
    base_.push_back(base);
    shift_.push_back(shift);
    inside_.resize(delaunay_.faces().size(), 0);
    const std::vector<std::uint32_t> fresh(delaunay_.fresh().begin(), delaunay_.fresh().end());
    for (const std::uint32_t f : fresh)
      inside_[f] = delaunay_.is_finite(delaunay_.faces()[f]) || patch_.period > 0 ? inside : 0;
    for (const std::uint32_t f : fresh) consider(f);
    return true;
  }

  void refine() {
    for (std::uint32_t f = 0; f < delaunay_.faces().size(); ++f) consider(f);
    while (!waiting_.empty()) {
      throw_if_interrupted();
      const Waiting next = waiting_.top();
      waiting_.pop();
      const Delaunay::Face& f = delaunay_.faces()[next.face];
      if (!f.is_alive || f.stamp != next.stamp) continue;
      Vector<3> point = delaunay_.circumcenter(f);
      if (patch_.period > 0) {
        const double turns = std::floor(point[0] / patch_.period);
        if (turns != 0) {  // its copy in the period is inserted, and this with it
          point[0] -= turns * patch_.period;
          const std::uint32_t at = delaunay_.locate(point, next.face);
          if (at == Delaunay::none || !inside_[at]) continue;
          insert_with_copies(point, at);
          continue;
        }
      }
      insert_with_copies(point, next.face);
    }
  }

  void insert_with_copies(const Vector<3>& point, std::uint32_t from) {
    const auto base = static_cast<std::uint32_t>(bases_);
    if (!insert(point, from, 0, 0) || !(patch_.period > 0)) return;
    for (const int s : {-1, 1}) {
      const Vector<3> copy = point + Vector<3>(s * patch_.period, 0, 0);
      if (copy[0] < -patch_.margin || copy[0] > patch_.period + patch_.margin) continue;
      const std::uint32_t at = delaunay_.locate(copy, Delaunay::none);
      if (at != Delaunay::none) insert(copy, at, base, s);
    }
  }

  double star_quality(std::span<const std::uint32_t> star, std::uint32_t point, const Vector<3>& at) const {
    double least = 2;
    for (const std::uint32_t face : star) {
      const Delaunay::Face& f = delaunay_.faces()[face];
      std::array<Vector<3>, 3> c;
      for (std::size_t k = 0; k < 3; ++k)
        c[k] = f.corners[k] == point ? at : delaunay_.points()[f.corners[k]];
      if (!delaunay_.runs_counterclockwise(c[0], c[1], c[2])) return -1;
      least = std::min(least, tangent_of_least_angle(c[0], c[1], c[2]));
    }
    return least;
  }

  void smooth() {
    constexpr int rounds = 4;
    const std::size_t n = delaunay_.points().size();
    std::vector<std::array<std::uint32_t, 2>> copies;  // in strips, of points by what they are copies of
    for (std::uint32_t p = 0; p < n; ++p)
      if (shift_[p] != 0 && base_[p] >= fixed_) copies.push_back({base_[p], p});
    std::ranges::sort(copies);
    for (int round = 0; round < rounds; ++round) {
      std::vector<std::vector<std::uint32_t>> stars(n);
      for (std::uint32_t f = 0; f < delaunay_.faces().size(); ++f) {
        const Delaunay::Face& face = delaunay_.faces()[f];
        if (!face.is_alive || !delaunay_.is_finite(face)) continue;
        for (const std::uint32_t c : face.corners)
          if (base_[c] >= fixed_ && shift_[c] == 0) stars[c].push_back(f);
      }
      for (std::uint32_t p = 0; p < n; ++p) {
        if (stars[p].empty() || !inside_[stars[p].front()]) continue;
        Vector<3> sum = Vector<3>::Zero();
        for (const std::uint32_t f : stars[p])
          for (const std::uint32_t c : delaunay_.faces()[f].corners)
            if (c != p) sum += delaunay_.points()[c];
        sum /= 2 * static_cast<double>(stars[p].size());
        if (on_sphere()) sum *= patch_.extent / sum.norm();
        if (patch_.period > 0 && (sum[0] < 0 || sum[0] >= patch_.period)) continue;
        const Vector<3> before = delaunay_.points()[p];
        if (!(star_quality(stars[p], p, sum) > star_quality(stars[p], p, before))) continue;
        delaunay_.move(p, sum);
        for (auto c = std::ranges::lower_bound(copies, std::array{base_[p], 0u});
             c != copies.end() && (*c)[0] == base_[p]; ++c)
          delaunay_.move((*c)[1], sum + Vector<3>(shift_[(*c)[1]] * patch_.period, 0, 0));
      }
      delaunay_.restore();
    }
  }

  PatchMesh collected() const {
    PatchMesh made;
    const auto& points = delaunay_.points();
    made.added.resize(bases_ - fixed_);
    for (std::size_t p = 0; p < points.size(); ++p)
      if (shift_[p] == 0 && base_[p] >= fixed_) made.added[base_[p] - fixed_] = points[p];
    const auto& faces = delaunay_.faces();
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (faces[f].is_alive && inside_[f] && delaunay_.is_finite(faces[f]) && is_own(faces[f]))
        made.triangles.push_back(
            {base_[faces[f].corners[0]], base_[faces[f].corners[1]], base_[faces[f].corners[2]]});
    return made;
  }

  const BoundedPart& patch_;
  std::size_t fixed_;  ///< points of the boundary
  std::size_t bases_ = 0;
  Delaunay delaunay_;
  std::vector<char> inside_;
  std::vector<std::uint32_t> base_;  ///< of each point, the one that it is a copy of
  std::vector<int> shift_;           ///< in periods
  std::priority_queue<Waiting> waiting_;
};

}  // namespace

double least_angle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
  return std::atan(tangent_of_least_angle(a, b, c));
}

std::vector<Vector<3>> icosahedron() {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vector<3>> corners;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g})
      for (const Vector<3>& p : {Vector<3>(0, a, b), Vector<3>(a, b, 0), Vector<3>(b, 0, a)})
        corners.push_back(p.normalized());
  return corners;
}

PatchMesh mesh_patch(const BoundedPart& patch) { return Mesher(patch).made(); }

}  // namespace bernal
