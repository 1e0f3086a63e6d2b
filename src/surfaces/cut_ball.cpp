#include "surfaces/cut_ball.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace bernal {
namespace {

/// Relative to the longest edge: nearer corners are moved onto the plane.
constexpr double snap_distance = 0.2;
/// Relative to the height of the cap that the largest triangle leaves.
constexpr double least_cap_share = 1.25;

bool comes_before(const Vector<3>& a, const Vector<3>& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Adds a plane in order; absent if there are three already.
std::optional<CutBall::Corner> also_on(CutBall::Corner corner, int plane) {
  const int n = corner.count();
  if (n == 3) return std::nullopt;
  corner.planes[static_cast<std::size_t>(n)] = plane;
  std::sort(corner.planes.begin(), corner.planes.begin() + n + 1);
  return corner;
}

bool lies_on(const CutBall::Corner& corner, int plane) {
  return std::ranges::find(corner.planes, plane) != corner.planes.end();
}

}  // namespace

int CutBall::Corner::count() const {
  return static_cast<int>(std::ranges::find(planes, -1) - planes.begin());
}

CutBall::CutBall(int frequency, double radius, const std::vector<BallPlane>& planes)
    : radius_(radius), planes_(planes) {
  const Icosphere& whole = icosphere(frequency);
  least_cap_ = least_cap_share * (1 - whole.inradius) * radius;
  // A triangle with corners on the sphere that leaves a cap of that height has edges of about sqrt(6 height)
  // radii.
  edge_ = std::sqrt(6 * (1 - whole.inradius)) * radius;
  for (const Vector<3>& v : whole.vertices) corners_.push_back({radius * v});
  for (const auto& [a, b, c] : whole.triangles) faces_.push_back({-1, {a, b, c}});
}

double CutBall::height(const Vector<3>& place, const BallPlane& plane) {
  return plane.normal.dot(place) - plane.offset;
}

/// Whether the corner stays on its side of all planes of earlier cuts that it does not lie on.
bool CutBall::may_move(const Corner& from, const Vector<3>& to) const {
  return std::ranges::all_of(done_, [&](int number) {
    const BallPlane& plane = planes_[static_cast<std::size_t>(number)];
    return lies_on(from, number) || height(from.place, plane) * height(to, plane) > 0;
  });
}

/// The position of the corner on all its planes and, if these leave a degree of freedom, on the sphere.
/// Absent if the planes do not meet within the sphere.
std::optional<Vector<3>> CutBall::placed(const Corner& corner) const {
  const int n = corner.count();
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> normals(n, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> offsets(n);
  for (int k = 0; k < n; ++k) {
    const BallPlane& plane = planes_[static_cast<std::size_t>(corner.planes[static_cast<std::size_t>(k)])];
    normals.row(k) = plane.normal.transpose();
    offsets[k] = plane.offset;
  }
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram = normals * normals.transpose();
  const auto solver = gram.fullPivLu();
  if (std::abs(gram.determinant()) < 1e-6) return std::nullopt;
  const Vector<3> foot = normals.transpose() * solver.solve(offsets);
  Vector<3> place = foot;
  const double left = radius_ * radius_ - foot.squaredNorm();
  if (n == 3) {
    if (left < 0) return std::nullopt;
  } else {
    const Vector<3> from_foot = corner.place - foot;
    const Vector<3> within = from_foot - normals.transpose() * solver.solve(normals * from_foot);
    const double length = within.norm();
    if (!(left > 0) || !(length > 1e-9 * radius_)) return std::nullopt;
    if (n == 1) {
      place += std::sqrt(left) / length * within;
    } else {  // one of two points, independent of the corner's path
      const Vector<3> along = normals.row(0).cross(normals.row(1)).normalized();
      place += (within.dot(along) < 0 ? -1 : 1) * std::sqrt(left) * along;
    }
  }
  for (int k = 0; k < n; ++k)  // exact coordinate for planes normal to an axis
    for (int axis = 0; axis < 3; ++axis)
      if (normals.row(k) == Vector<3>::Unit(axis).transpose()) place[axis] = offsets[k];
  return place;
}

/// Pushes a tip beyond the plane slightly below it.
void CutBall::push_in(const BallPlane& plane, bool below) {
  const double side = below ? 1 : -1, limit = -0.25 * least_cap_;
  for (Corner& corner : corners_) {
    const double over = side * height(corner.place, plane) - limit;
    const bool stays_on = std::ranges::all_of(corner.planes, [&](int on) {
      return on < 0 || planes_[static_cast<std::size_t>(on)].normal.dot(plane.normal) == 0;
    });
    if (over > 0 && stays_on) corner.place -= side * over * plane.normal;
  }
}

/// Moves corners near the plane onto it, as long as one is left beyond it of a ball that the plane cuts: the
/// nearest to the pole is no deeper than the largest triangle leaves. If a whole face would lie in the plane
/// and belong to neither half, its farthest corner stays. If nothing is left on one side of a ball with
/// earlier cuts, corners on no other plane are moved back, slightly below it.
void CutBall::snap(int number) {
  const BallPlane& plane = planes_[static_cast<std::size_t>(number)];
  const double cap = radius_ - std::abs(plane.offset), left = least_cap_ / least_cap_share;
  const double near = std::min(snap_distance * edge_, 0.5 * (cap - left));
  std::map<std::uint32_t, Corner> moved_alone;  // original positions of corners on no other plane
  for (std::uint32_t v = 0; v < corners_.size(); ++v) {
    Corner& corner = corners_[v];
    std::optional<Corner> moved =
        std::abs(height(corner.place, plane)) < near ? also_on(corner, number) : std::nullopt;
    const std::optional<Vector<3>> place = moved ? placed(*moved) : std::nullopt;
    if (!place || !may_move(*moved, *place) || !((*place - corner.place).norm() < 2 * snap_distance * edge_))
      continue;
    if (corner.count() == 0) moved_alone.emplace(v, corner);
    moved->place = *place;
    corner = *moved;
  }
  for (const Face& face : faces_) {
    if (!std::ranges::all_of(face.corners, [&](auto v) { return lies_on(corners_[v], number); })) continue;
    const auto distance = [&](std::uint32_t v) {
      const auto from = moved_alone.find(v);
      return from == moved_alone.end() ? -1 : std::abs(height(from->second.place, plane));
    };
    const auto from = moved_alone.find(*std::ranges::max_element(face.corners, {}, distance));
    if (from == moved_alone.end()) continue;
    corners_[from->first] = from->second;
    moved_alone.erase(from);
  }
  bool any_above = false, any_below = false;
  for (const Corner& corner : corners_)
    if (!lies_on(corner, number)) (height(corner.place, plane) > 0 ? any_above : any_below) = true;
  if (any_above && any_below) return;
  const double side = any_above ? -1 : 1;
  for (const auto& [v, before] : moved_alone) {
    corners_[v] = before;
    const double over = side * height(before.place, plane) + 0.25 * near;
    if (over > 0) corners_[v].place -= side * over * plane.normal;
  }
}

std::uint32_t CutBall::crossing(std::uint32_t from, std::uint32_t to, int number) {
  const BallPlane& plane = planes_[static_cast<std::size_t>(number)];
  if (comes_before(corners_[to].place, corners_[from].place)) std::swap(from, to);
  const Corner &a = corners_[from], &b = corners_[to];
  const double above_a = height(a.place, plane), above_b = height(b.place, plane);
  Corner made{a.place + above_a / (above_a - above_b) * (b.place - a.place)};
  std::size_t n = 0;
  for (const int common : a.planes)
    if (common >= 0 && lies_on(b, common) && n < 2) made.planes[n++] = common;
  made = *also_on(made, number);
  if (const std::optional<Vector<3>> place = placed(made); place && may_move(made, *place))
    made.place = *place;
  for (int axis = 0; axis < 3; ++axis)
    if (plane.normal == Vector<3>::Unit(axis)) made.place[axis] = plane.offset;
  corners_.push_back(made);
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

bool CutBall::cut(int number, bool below) {
  const BallPlane& plane = planes_[static_cast<std::size_t>(number)];
  if (empty()) return true;
  if (radius_ - std::abs(plane.offset) < least_cap_) {
    if ((plane.offset > 0) == below)
      push_in(plane, below);
    else
      faces_.clear();
    done_.push_back(number);
    return true;
  }
  snap(number);
  done_.push_back(number);
  const double side = below ? 1 : -1;
  std::vector<int> sides(corners_.size());
  for (std::size_t v = 0; v < corners_.size(); ++v) {
    const double above = lies_on(corners_[v], number) ? 0 : side * height(corners_[v].place, plane);
    sides[v] = (above > 0) - (above < 0);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> crossings;
  std::vector<Face> kept;
  for (const Face& face : faces_) {
    Face part{face.plane, {}};
    bool inside = false;
    for (std::size_t k = 0; k < face.corners.size(); ++k) {
      const std::uint32_t a = face.corners[k], b = face.corners[(k + 1) % face.corners.size()];
      inside |= sides[a] < 0;
      if (sides[a] <= 0) part.corners.push_back(a);
      if (sides[a] * sides[b] >= 0) continue;
      const auto [at, is_new] = crossings.try_emplace(std::minmax(a, b), 0);
      if (is_new) at->second = crossing(a, b, number);
      part.corners.push_back(at->second);
    }
    if (inside && part.corners.size() >= 3) kept.push_back(std::move(part));
  }
  faces_ = std::move(kept);
  return empty() || close(number);
}

/// Adds the faces in the plane: their edges belong to a single kept face.
bool CutBall::close(int number) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Face& face : faces_)
    for (std::size_t k = 0; k < face.corners.size(); ++k)
      ++edges[{face.corners[k], face.corners[(k + 1) % face.corners.size()]}];
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, times] : edges) {
    if (times != 1) return false;
    const auto& [a, b] = edge;
    if (edges.contains({b, a})) continue;
    if (!lies_on(corners_[a], number) || !lies_on(corners_[b], number)) return false;
    if (!next.try_emplace(b, a).second) return false;
  }
  while (!next.empty()) {
    Face cap{number, {}};
    const std::uint32_t first = next.begin()->first;
    for (std::uint32_t at = first;;) {
      const auto found = next.find(at);
      if (found == next.end()) return false;
      cap.corners.push_back(at);
      at = found->second;
      next.erase(found);
      if (at == first) break;
    }
    if (cap.corners.size() < 3) return false;
    faces_.push_back(std::move(cap));
  }
  return true;
}

std::vector<std::array<std::uint32_t, 3>> CutBall::triangles_of(const Face& face) const {
  std::vector<std::array<std::uint32_t, 3>> made;
  std::vector<std::uint32_t> ring = face.corners;
  const auto place = [&](std::uint32_t v) -> const Vector<3>& { return corners_[v].place; };
  if (face.plane < 0) {  // the fan that leaves the least of the ball
    std::size_t best = 0;
    double most = -1;
    const auto corner = [&](std::size_t k) { return ring[k % ring.size()]; };
    for (std::size_t apex = 0; apex < ring.size(); ++apex) {
      double volume = 0;
      for (std::size_t k = 1; k + 1 < ring.size(); ++k)
        volume += place(corner(apex)).dot(place(corner(apex + k)).cross(place(corner(apex + k + 1))));
      if (volume > most) most = volume, best = apex;
    }
    for (std::size_t k = 1; k + 1 < ring.size(); ++k)
      made.push_back({corner(best), corner(best + k), corner(best + k + 1)});
    return made;
  }
  // Merges corners at the same position.
  const auto same = [&](std::uint32_t a, std::uint32_t b) { return place(a) == place(b); };
  ring.erase(std::unique(ring.begin(), ring.end(), same), ring.end());
  while (ring.size() > 1 && same(ring.front(), ring.back())) ring.pop_back();
  if (ring.size() < 3) return {};
  // A convex polygon: bisected recursively, from a corner and in an orientation that both halves of the ball
  // agree on.
  Vector<3> area = Vector<3>::Zero();
  for (std::size_t k = 2; k < ring.size(); ++k)
    area += (place(ring[k - 1]) - place(ring[0])).cross(place(ring[k]) - place(ring[0]));
  const bool turned = area.dot(planes_[static_cast<std::size_t>(face.plane)].normal) < 0;
  if (turned) std::ranges::reverse(ring);
  const auto first = std::ranges::min_element(
      ring, [&](std::uint32_t a, std::uint32_t b) { return comes_before(place(a), place(b)); });
  std::ranges::rotate(ring, first);
  const auto halve = [&](auto self, std::size_t from, std::size_t to) -> void {
    if (to - from < 2) return;
    const std::size_t middle = (from + to) / 2;
    made.push_back({ring[from], ring[middle], ring[to]});
    self(self, from, middle);
    self(self, middle, to);
  };
  halve(halve, 0, ring.size() - 1);
  if (turned)
    for (auto& triangle : made) std::swap(triangle[1], triangle[2]);
  return made;
}

}  // namespace bernal
