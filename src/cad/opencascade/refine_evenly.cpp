#include "cad/opencascade/refine_evenly.hpp"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/curved_patch.hpp"

namespace bernal::cad {
namespace {

constexpr std::uint32_t none = 0xFFFFFFFF;

class EvenRefinement {
 public:
  EvenRefinement(const BRepAdaptor_Surface& surface, const std::vector<NodePair>& poles, double most,
                 FaceTriangles& face)
      : surface_(surface), most_(most), face_(face) {
    for (const gp_XY& at : face.parameters) on_surface_.push_back(place_at(at));
    std::unordered_map<std::uint64_t, std::pair<std::uint32_t, int>> open;
    for (const FaceTriangles::Corners& corners : face.triangles) {
      const auto t = static_cast<std::uint32_t>(all_.size());
      Triangle& added = all_.emplace_back();
      for (int k = 0; k < 3; ++k) {
        added.corner[k] = corners[k];
        const std::uint32_t from = corners[k], to = corners[(k + 1) % 3];
        const std::uint64_t key = std::uint64_t{std::min(from, to)} << 32U | std::max(from, to);
        const auto [entry, is_new] = open.try_emplace(key, t, k);
        if (is_new) {
          added.sag[k] = sag_of(from, to);
          continue;
        }
        const auto [other, edge] = entry->second;
        added.sag[k] = all_[other].sag[edge];
        if (all_[other].beside[edge] != none) continue;  // a third one: it is no surface there
        added.beside[k] = other;
        all_[other].beside[edge] = t;
      }
    }
    for (const NodePair& pole : poles) at_pole_.insert(ascending(pole[0], pole[1]));
  }

  /// Larger bends first: so triangles keep their shape.
  double run() {
    open_poles();
    double largest = 0;
    for (const Triangle& triangle : all_) largest = std::max(largest, bend_of(triangle));
    for (double now = largest; now > most_;) {
      now = std::max(most_, 0.5 * now);
      for (std::uint32_t t = 0; t < all_.size() && all_.size() + 2 <= most_triangles; ++t)
        while (bend_of(all_[t]) > now && all_.size() + 2 <= most_triangles)
          if (!split(t)) break;
    }
    face_.triangles.clear();
    largest = 0;
    for (const Triangle& triangle : all_) {
      face_.triangles.push_back(triangle.corner);
      largest = std::max(largest, bend_of(triangle));
    }
    return largest;
  }

 private:
  static constexpr std::size_t most_triangles = 4'000'000;

  /// Edge k runs from corner k to the next.
  struct Triangle {
    std::array<std::uint32_t, 3> corner;
    std::array<std::uint32_t, 3> beside{none, none, none};
    std::array<double, 3> sag{};
  };

  static double bend_of(const Triangle& t) {
    return bend_of_edges({8 * t.sag[0], 8 * t.sag[1], 8 * t.sag[2]});
  }

  Vector<3> place_at(const gp_XY& at) const { return vector_of(surface_.Value(at.X(), at.Y())); }

  double sag_of(std::uint32_t a, std::uint32_t b) const {
    const Vector<3> middle = 0.5 * (on_surface_[a] + on_surface_[b]);
    return (place_at((face_.parameters[a] + face_.parameters[b]) * 0.5) - middle).norm();
  }

  /// Twice the area in the plane of parameters.
  double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const gp_XY &p = face_.parameters[a], &q = face_.parameters[b], &r = face_.parameters[c];
    return (q - p).Crossed(r - p);
  }

  Vector<3> area_vector(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (on_surface_[b] - on_surface_[a]).cross(on_surface_[c] - on_surface_[a]);
  }

  std::uint32_t add_node(const gp_XY& at, const Vector<3>& place) {
    face_.parameters.push_back(at);
    face_.places.push_back(place);
    on_surface_.push_back(place);
    return static_cast<std::uint32_t>(face_.places.size() - 1);
  }

  int edge_of(std::uint32_t t, std::uint32_t beside) const {
    return static_cast<int>(std::ranges::find(all_[t].beside, beside) - all_[t].beside.begin());
  }

  void put_beside(std::uint32_t t, std::uint32_t before, std::uint32_t now) {
    if (t != none) all_[t].beside[edge_of(t, before)] = now;
  }

  /// A node in edge k of t, which becomes two triangles; appends the other one, which has the edge's end.
  std::uint32_t cut(std::uint32_t t, int k, std::uint32_t node) {
    const auto other = static_cast<std::uint32_t>(all_.size());
    const Triangle old = all_[t];
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    const std::uint32_t apex = old.corner[last];
    const double across = sag_of(node, apex);
    Triangle& here = all_[t];
    here.corner[next] = node;
    here.sag[k] = sag_of(old.corner[k], node);
    here.sag[next] = across;
    here.beside[next] = other;
    Triangle there;
    there.corner = {node, old.corner[next], apex};
    there.sag = {sag_of(node, old.corner[next]), old.sag[next], across};
    there.beside = {none, old.beside[next], t};
    all_.push_back(there);
    put_beside(old.beside[next], t, other);
    return other;
  }

  /// Splits the inner edge with the largest sag of those that are long enough; false if there is none.
  bool split(std::uint32_t t) {
    int edge = -1;
    double largest = 0.1 * most_;
    // Beside an edge of the face that bends more, smaller triangles would bend as much.
    for (int k = 0; k < 3; ++k)
      if (all_[t].beside[k] == none) largest = std::max(largest, 0.6 * all_[t].sag[k]);
    for (int k = 0; k < 3; ++k) {
      if (all_[t].beside[k] == none || !(all_[t].sag[k] > largest)) continue;
      const auto a = all_[t].corner[k], b = all_[t].corner[(k + 1) % 3];
      if (!((face_.places[a] - face_.places[b]).norm() > most_) && face_.places[a] != face_.places[b])
        continue;
      edge = k, largest = all_[t].sag[k];
    }
    if (edge < 0) return false;
    const std::uint32_t other = all_[t].beside[edge];
    const int back = edge_of(other, t);
    const gp_XY at =
        (face_.parameters[all_[t].corner[edge]] + face_.parameters[all_[t].corner[(edge + 1) % 3]]) * 0.5;
    const std::uint32_t node = add_node(at, place_at(at));
    const std::uint32_t t2 = cut(t, edge, node), other2 = cut(other, back, node);
    // The first halves begin at opposite ends.
    all_[t].beside[edge] = other2;
    all_[other2].beside[0] = t;
    all_[other].beside[back] = t2;
    all_[t2].beside[0] = other;
    turn_around({t, t2, other, other2}, node);
    return true;
  }

  /// Turns the edges opposite to a node as long as that makes the more bent triangle less bent.
  void turn_around(std::vector<std::uint32_t> waiting, std::uint32_t node) {
    int left = 64;
    while (!waiting.empty() && --left > 0) {
      const std::uint32_t t = waiting.back();
      waiting.pop_back();
      const auto corner = std::ranges::find(all_[t].corner, node);
      if (corner == all_[t].corner.end()) continue;
      const int k = static_cast<int>((corner - all_[t].corner.begin() + 1) % 3);
      const std::uint32_t other = all_[t].beside[k];
      if (other == none || !turn(t, k)) continue;
      waiting.push_back(t);
      waiting.push_back(other);
    }
  }

  /// Joins the corners opposite to an edge in its place.
  bool turn(std::uint32_t t, int k) {
    const std::uint32_t o = all_[t].beside[k];
    const int j = edge_of(o, t);
    const Triangle &one = all_[t], &two = all_[o];
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const std::uint32_t a = one.corner[k], b = one.corner[k1], c = one.corner[k2], d = two.corner[j2];
    if (c == d || one.beside[k1] == o || one.beside[k2] == o) return false;
    const double all = area(a, b, c) + area(b, a, d), left = area(c, a, d), right = area(d, b, c);
    constexpr double thin = 1e-3;
    if (!(left * all > thin * all * all && right * all > thin * all * all)) return false;
    // A needle along a bent edge would stand across the surface.
    const Vector<3> sides[] = {area_vector(c, a, d), area_vector(d, b, c)}, sum = sides[0] + sides[1];
    constexpr double least_cosine = 0.5;
    for (const Vector<3>& side : sides)
      if (!(side.dot(sum) > least_cosine * side.norm() * sum.norm()) && side.norm() > 0) return false;
    const double across = sag_of(c, d);
    // c a d has the edges ca, ad, dc; d b c has db, bc, cd.
    const Triangle first{{c, a, d}, {one.beside[k2], two.beside[j1], o}, {one.sag[k2], two.sag[j1], across}};
    const Triangle second{{d, b, c}, {two.beside[j2], one.beside[k1], t}, {two.sag[j2], one.sag[k1], across}};
    if (!(std::max(bend_of(first), bend_of(second)) < 0.99 * std::max(bend_of(one), bend_of(two))))
      return false;
    put_beside(two.beside[j1], o, t);
    put_beside(one.beside[k1], t, o);
    all_[t] = first;
    all_[o] = second;
    return true;
  }

  /// A triangle at a pole whose opposite corner lies between the two nodes there gets a node in front of it.
  void open_poles() {
    if (at_pole_.empty()) return;
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t t = 0; t < all_.size(); ++t) waiting.push_back(t);
    while (!waiting.empty() && all_.size() + 2 <= most_triangles) {
      const std::uint32_t t = waiting.back();
      waiting.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto a = all_[t].corner[k], b = all_[t].corner[(k + 1) % 3], c = all_[t].corner[(k + 2) % 3];
        if (all_[t].beside[k] != none || !at_pole_.contains(ascending(a, b))) continue;
        const gp_XY along = face_.parameters[b] - face_.parameters[a];
        const double share = (face_.parameters[c] - face_.parameters[a]) * along / along.SquareModulus();
        if (!(share > 0.05 && share < 0.95)) continue;
        const std::uint32_t node = add_node(face_.parameters[a] + along * share, face_.places[a]);
        on_surface_[node] = place_at(face_.parameters[node]);
        const auto pole = face_.at_pole.find(a);
        face_.at_pole[node] = pole == face_.at_pole.end() ? a : pole->second;
        face_.cuts.push_back({a, b, node});
        at_pole_.insert({ascending(a, node), ascending(node, b)});
        const std::uint32_t other = cut(t, k, node);
        turn_around({t, other}, node);
        for (std::uint32_t more : {t, other})
          for (std::uint32_t near : all_[more].beside)
            if (near != none) waiting.push_back(near);
        waiting.push_back(t);
        waiting.push_back(other);
        break;
      }
    }
  }

  const BRepAdaptor_Surface& surface_;
  double most_;
  FaceTriangles& face_;
  std::vector<Vector<3>> on_surface_;  ///< of the nodes; that of an edge may be off by its tolerance
  std::vector<Triangle> all_;
  std::set<NodePair> at_pole_;
};

}  // namespace

double refine_evenly(const BRepAdaptor_Surface& surface, const std::vector<NodePair>& poles, double most,
                     FaceTriangles& face) {
  return EvenRefinement(surface, poles, most, face).run();
}

}  // namespace bernal::cad
