#include "measure/cell_in_container.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bernal {
namespace {

/// Of the length of a cell: what the clearance half-way between two corners may be off the mean of theirs,
/// and the longest edge of what is halved no further. A wall that bends away from its chords by e over a cell
/// of edge s takes e s² of its s³; a crease of it that is met only by parts of edge h takes h² s.
constexpr double most_bend = 1e-3, largest_part = 0.5, smallest_part = 0.04;

template <int N>
struct Simplex {
  std::array<Vector<3>, N + 1> corner;
  std::array<double, N + 1> clearance;
};

double size_of(const Simplex<2>& s) {
  const Vector<3> a = s.corner[1] - s.corner[0], b = s.corner[2] - s.corner[0];
  return 0.5 * (a[0] * b[1] - a[1] * b[0]);
}
double size_of(const Simplex<3>& s) {
  return (s.corner[1] - s.corner[0]).dot((s.corner[2] - s.corner[0]).cross(s.corner[3] - s.corner[0])) / 6;
}

/// Of the edge from a corner where the clearance is f, what is on its side of zero.
double part_inside(double f, double other) { return f / (f - other); }

/// The share of a simplex where the linear interpolant of the clearances at its corners is positive.
template <int N>
double inside_share(std::array<double, N + 1> f) {
  const auto inside = std::partition(f.begin(), f.end(), [](double v) { return v > 0; }) - f.begin();
  if (inside == 0) return 0;
  if (inside == N + 1) return 1;
  const auto corner_share = [&](std::size_t k) {  // the corner k is alone on its side
    double share = 1;
    for (std::size_t j = 0; j < f.size(); ++j)
      if (j != k) share *= part_inside(f[k], f[j]);
    return share;
  };
  if (inside == 1) return corner_share(0);
  if (inside == N) return 1 - corner_share(N);
  if constexpr (N == 3) {  // a wedge between the corners 0 and 1, in three tetrahedra
    const double s02 = part_inside(f[0], f[2]), s03 = part_inside(f[0], f[3]), s12 = part_inside(f[1], f[2]),
                 s13 = part_inside(f[1], f[3]);
    return s02 * s03 + s02 * (1 - s03) * s13 + (1 - s02) * s12 * s13;
  }
  return 0;
}

/// Halves a simplex and what comes of it.
template <int N>
class Division {
 public:
  /// See `CellInContainer` for `length`.
  Division(const Container& container, double length)
      : container_(container),
        tolerance_(most_bend * length),
        largest_(largest_part * length),
        smallest_(smallest_part * length) {}

  /// `calm`: how many halvings in a row have found the clearance linear; as many as there are dimensions have
  /// looked along all of them.
  double inside(const Simplex<N>& s, double size, int calm) const {
    double longest = 0;
    std::size_t a = 0, b = 1;
    std::array<double, N + 1> farthest{};
    for (std::size_t i = 0; i < s.corner.size(); ++i) {
      for (std::size_t j = i + 1; j < s.corner.size(); ++j) {
        const double edge = (s.corner[i] - s.corner[j]).norm();
        farthest[i] = std::max(farthest[i], edge);
        farthest[j] = std::max(farthest[j], edge);
        if (edge > longest) {
          longest = edge;
          a = i;
          b = j;
        }
      }
    }
    for (std::size_t i = 0; i < s.corner.size(); ++i) {
      if (s.clearance[i] >= farthest[i]) return size;
      if (s.clearance[i] <= -farthest[i]) return 0;
    }
    if (longest <= smallest_ || (calm >= N && longest <= largest_ && is_linear(s, longest)))
      return size * inside_share<N>(s.clearance);
    const Vector<3> middle = 0.5 * (s.corner[a] + s.corner[b]);
    const double clearance = container_.clearance_within(middle, longest);
    const double off = std::abs(clearance - 0.5 * (s.clearance[a] + s.clearance[b]));
    calm = longest <= largest_ && off <= tolerance_ ? calm + 1 : 0;
    double sum = 0;
    for (const std::size_t replaced : {a, b}) {
      Simplex<N> half = s;
      half.corner[replaced] = middle;
      half.clearance[replaced] = clearance;
      sum += inside(half, 0.5 * size, calm);
    }
    return sum;
  }

 private:
  /// Also in the middle.
  bool is_linear(const Simplex<N>& s, double longest) const {
    Vector<3> middle = Vector<3>::Zero();
    double mean = 0;
    for (std::size_t k = 0; k < s.corner.size(); ++k) {
      middle += s.corner[k] / (N + 1);
      mean += s.clearance[k] / (N + 1);
    }
    return std::abs(container_.clearance_within(middle, longest) - mean) <= tolerance_;
  }

  const Container& container_;
  double tolerance_, largest_, smallest_;
};

}  // namespace

template <int N>
double CellInContainer::volume_of_parts(const ConvexCell& cell, const Vector<3>& center,
                                        double length) const {
  const Division<N> division(container_, length);
  const auto corners = cell.corners();
  const auto place = [&](Vector<3> p) {
    p += center;
    if (N == 2) p[2] = 0;
    return p;
  };
  Vector<3> mean = Vector<3>::Zero();
  for (const ConvexCell::Corner& corner : corners) mean += corner.point;
  const Vector<3> apex = place(mean / static_cast<double>(corners.size()));
  double farthest = 0;
  for (const ConvexCell::Corner& corner : corners)
    farthest = std::max(farthest, (place(corner.point) - apex).norm());
  const double beyond = 2 * farthest;  // no edge is longer
  const auto clearance = [&](const Vector<3>& p) { return container_.clearance_within(p, beyond); };
  const double at_apex = clearance(apex);
  if (at_apex >= farthest) return cell.volume();
  if (at_apex <= -farthest) return 0;
  if (polygons_) return polygons_->volume_inside(cell, center);
  std::vector<double> at_corner;
  for (const ConvexCell::Corner& corner : corners) at_corner.push_back(clearance(place(corner.point)));

  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> first_of_face;
  double sum = 0;
  for (const ConvexCell::Edge& edge : cell.edges()) {
    Simplex<N> part;
    part.corner[0] = apex;
    part.clearance[0] = at_apex;
    const auto set = [&](std::size_t k, std::uint32_t corner) {
      part.corner[k] = place(corners[corner].point);
      part.clearance[k] = at_corner[corner];
    };
    set(1, edge.from);
    set(2, edge.to);
    if constexpr (N == 2) {
      if (edge.face != ConvexCell::top) continue;
    } else {
      if (edge.face >= first_of_face.size()) first_of_face.resize(edge.face + 1, none);
      std::uint32_t& first = first_of_face[edge.face];
      if (first == none) first = edge.from;
      if (first == edge.from || first == edge.to) continue;  // flat
      set(3, first);
    }
    sum += division.inside(part, size_of(part), 0);
  }
  return sum;
}

CellInContainer::CellInContainer(const Domain& domain, const Container& container)
    : container_(container), length_(container.dimension() * container.volume() / area_of(domain)) {
  if (is_faceted(domain) && container.inset() == 0) polygons_.emplace(domain, container);
}

double CellInContainer::volume(const ConvexCell& cell, const Vector<3>& center) const {
  if (cell.empty()) return 0;
  const int dimension = container_.dimension();
  const double own = cell.volume();
  if (!(own > 0)) return 0;
  const double length = std::min(length_, dimension == 2 ? std::sqrt(own) : std::cbrt(own));
  return dimension == 2 ? volume_of_parts<2>(cell, center, length) : volume_of_parts<3>(cell, center, length);
}

}  // namespace bernal
