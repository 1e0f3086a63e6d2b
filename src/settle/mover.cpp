#include "settle/mover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "domain/free_path.hpp"
#include "kernels/first_contact.hpp"

namespace bernal {
namespace {

/// A motion as the loop over the neighbours sees it.
struct Motion {
  double ux, uy, uz, skin;
};

/// path[k]: how far a sphere may move until neighbour k is a skin away, infinite where it passes at skin/2 or
/// more or recedes. The same formula as kernels/first_contact.hpp without its care for rounding.
[[gnu::always_inline]] inline void paths(const double* __restrict x, const double* __restrict y,
                                         const double* __restrict z, const double* __restrict sum,
                                         double* __restrict path, std::size_t n, const Motion& m) {
  constexpr double never = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    const double along = x[k] * m.ux + y[k] * m.uy + z[k] * m.uz;
    const double dx = x[k] - along * m.ux, dy = y[k] - along * m.uy, dz = z[k] - along * m.uz;
    const double squared_miss = dx * dx + dy * dy + dz * dz;
    const double stop = sum[k] + m.skin, ignore = sum[k] + 0.5 * m.skin;
    const double room = stop * stop - squared_miss;
    const double contact = along - std::sqrt(room > 0 ? room : 0);
    const bool meets = (along > 0) & (squared_miss < ignore * ignore);
    path[k] = meets ? contact : never;
  }
}

// The same arithmetic, compiled for four lanes and for two: the bits do not depend on which one runs.
[[gnu::target("avx2")]] void paths_avx2(const double* __restrict x, const double* __restrict y,
                                        const double* __restrict z, const double* __restrict sum,
                                        double* __restrict path, std::size_t n, const Motion& m) {
  paths(x, y, z, sum, path, n, m);
}
void paths_sse2(const double* __restrict x, const double* __restrict y, const double* __restrict z,
                const double* __restrict sum, double* path, std::size_t n, const Motion& m) {
  paths(x, y, z, sum, path, n, m);
}
const auto paths_here = __builtin_cpu_supports("avx2") ? paths_avx2 : paths_sse2;

/// A leg that keeps less than this of the wanted direction is not worth its length.
constexpr double least_progress = 1e-3;
/// A direction that rounding alone turns into a contact does not point into it.
constexpr double tangent_rounding = 1e-12;
/// Two contacts whose normals enclose a smaller angle (squared sine) hold like one.
constexpr double parallel = 1e-12;
/// An obstacle this near, in radii, counts as a contact: moving up to it first is not worth a leg.
constexpr double contact_gap = 1e-6;
/// More obstacles cannot oppose a sphere that touches them all, unless they are much smaller than it is;
/// beyond that number it is taken as held.
constexpr std::size_t most_contacts = 16;
constexpr int most_legs = 4;

using Normals = std::span<const Vector<3>>;

bool points_into_none(const Vector<3>& d, Normals normals) {
  for (const Vector<3>& n : normals) {
    if (d.dot(n) < -tangent_rounding) return false;
  }
  return true;
}

/// The feasible direction that keeps most of `wanted`: `wanted` itself, its projection onto the plane of one
/// contact, or onto the line of two. Its length is the share that it keeps; zero if the contacts hold it.
Vector<3> part_left_free(const Vector<3>& wanted, Normals normals) {
  if (points_into_none(wanted, normals)) return wanted;
  Vector<3> best = Vector<3>::Zero();
  double longest = least_progress * least_progress;
  const auto offer = [&](const Vector<3>& d) {
    const double squared = d.squaredNorm();
    if (squared <= longest || !points_into_none(d, normals)) return false;
    longest = squared;
    best = d;
    return true;
  };
  bool in_a_plane = false;
  for (const Vector<3>& n : normals) in_a_plane |= offer(wanted - wanted.dot(n) * n);
  if (in_a_plane) return best;
  for (std::size_t a = 1; a < normals.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Vector<3> line = normals[a].cross(normals[b]);
      const double squared = line.squaredNorm();
      if (squared > parallel) offer((wanted.dot(line) / squared) * line);
    }
  }
  return best;
}

}  // namespace

void Mover::pick(Bed::Id i) {
  i_ = i;
  const std::span<const Bed::Id> neighbors = bed_.neighbors(i);
  count_ = neighbors.size();
  if (x_.size() < count_) {
    for (auto* column : {&x_, &y_, &z_, &sum_, &path_}) column->resize(2 * count_);
  }
  const Bed::Ball ball = bed_[i];
  for (std::size_t k = 0; k < count_; ++k) {
    const Bed::Ball& other = bed_[neighbors[k]];
    x_[k] = other.center[0] - ball.center[0];
    y_[k] = other.center[1] - ball.center[1];
    z_[k] = other.center[2] - ball.center[2];
    sum_[k] = other.r + ball.r;
  }
  if (!bed_.meets_images_[i]) return;
  for (std::size_t k = 0; k < count_; ++k) {
    const Vector<3> way = bed_.container().boundary().minimum_image({x_[k], y_[k], z_[k]});
    x_[k] = way[0];
    y_[k] = way[1];
    z_[k] = way[2];
  }
}

FreePath Mover::free_path(const Vector<3>& u, double limit) {
  FreePath path{limit};
  limit_by_box(u, path);
  limit_by_neighbors(u, path);
  limit_by_walls(u, path);
  return path;
}

void Mover::limit_by_box(const Vector<3>& u, FreePath& path) const {
  const Vector<3> off = ball().center - bed_.box_centers_[i_];
  for (int k = 0; k < 3; ++k) {
    const double room = std::max(0.0, u[k] > 0 ? bed_.buffer_ - off[k] : bed_.buffer_ + off[k]);
    if (room < path.length * std::abs(u[k])) {
      path.length = room / std::abs(u[k]);
      path.end = FreePath::End::box;
    }
  }
}

void Mover::limit_by_neighbors(const Vector<3>& u, FreePath& path) {
  paths_here(x_.data(), y_.data(), z_.data(), sum_.data(), path_.data(), count_,
             {u[0], u[1], u[2], bed_.skin()});
  for (;;) {
    std::size_t first = count_;
    double shortest = path.length;
    for (std::size_t k = 0; k < count_; ++k) {
      if (path_[k] < shortest) {
        shortest = path_[k];
        first = k;
      }
    }
    if (first == count_) return;
    const Vector<3> to_other(x_[first], y_[first], z_[first]);
    const double length =
        first_contact<3>(Vector<3>::Zero(), u, path.length, to_other, sum_[first], bed_.skin());
    if (length < path.length) {
      path.length = length;
      path.end = FreePath::End::neighbor;
      path.normal = (length * u - to_other).normalized();
      return;
    }
    path_[first] = std::numeric_limits<double>::infinity();  // it only seemed to limit, by rounding
  }
}

void Mover::limit_by_walls(const Vector<3>& u, FreePath& path) const {
  const std::span<const NearFacet> facets = walls();
  if (facets.empty()) return;
  const double already_moved = moved();
  const NearFacet* blocker = nullptr;
  for (const NearFacet& near : facets) {
    // Facets stand in the order of their distance from the box's centre: the rest is out of reach.
    if (near.distance - already_moved - path.length > ball().r + 2 * bed_.skin()) break;
    const double length = first_contact_with(near.facet, u, path.length);
    if (length < path.length) {
      path.length = length;
      blocker = &near;
    }
  }
  if (blocker == nullptr) return;
  const Vector<3> end = ball().center + path.length * u;
  path.end = FreePath::End::wall;
  path.normal = (end - closest_point(blocker->facet, end)).normalized();
}

/// A few doubles before the wall in the one case, to the last bit in the other; the skin, half of which is
/// never used up, takes the rounding of the place where the sphere then stands.
double Mover::first_contact_with(const Facet& facet, const Vector<3>& u, double limit) const {
  if (Effect* exact = bed_.exact_walls()) {
    const EffectTimer timer(*exact);
    return first_contact_exactly(facet, {ball().center, ball().r, u, limit}, bed_.skin());
  }
  return first_contact(facet, ball().center, ball().r, u, limit, bed_.skin());
}

std::span<const NearFacet> Mover::walls() const {
  const std::size_t first = bed_.first_facet_[i_];
  return {bed_.facets_.data() + first, bed_.first_facet_[i_ + 1] - first};
}

std::size_t Mover::contacts(const Vector<3>& u, double gap, std::span<Vector<3>> normals) const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const double squared = x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k];
    const double touching = sum_[k] + gap;
    if (squared > touching * touching) continue;
    const Vector<3> to_other(x_[k], y_[k], z_[k]);
    if (to_other.dot(u) <= 0) continue;
    if (count == normals.size()) return count;
    normals[count++] = to_other / -std::sqrt(squared);
  }
  const std::span<const NearFacet> facets = walls();
  if (facets.empty()) return count;
  const double touching = ball().r + gap, already_moved = moved();
  for (const NearFacet& near : facets) {
    if (near.distance - already_moved > touching) break;
    const Vector<3> from_wall = ball().center - closest_point(near.facet, ball().center);
    const double squared = from_wall.squaredNorm();
    if (squared > touching * touching || from_wall.dot(u) >= 0) continue;
    if (count == normals.size()) return count;
    normals[count++] = from_wall / std::sqrt(squared);
  }
  return count;
}

void Mover::advance(const Vector<3>& u, double length) {
  const Vector<3> by = length * u;
  bed_.balls_[i_].center += by;
  for (std::size_t k = 0; k < count_; ++k) {
    x_[k] -= by[0];
    y_[k] -= by[1];
    z_[k] -= by[2];
  }
}

double Mover::slide(Bed::Id i, const Vector<3>& direction, double limit) {
  pick(i);
  std::array<Vector<3>, most_contacts> normals;
  const Vector<3> start = ball().center;
  std::size_t count = contacts(direction, contact_gap * ball().r + 2 * bed_.skin(), normals);
  for (int leg = 0; leg < most_legs && count < most_contacts; ++leg) {
    const Vector<3> part = part_left_free(direction, Normals(normals.data(), count));
    const double share = part.norm();
    if (share < least_progress) break;
    const Vector<3> u = part / share;
    const FreePath path = free_path(u, limit);
    advance(u, path.length);
    limit -= path.length;
    if (!path.blocked() || limit <= 0) break;
    normals[count++] = path.normal;
  }
  return (ball().center - start).norm();
}

}  // namespace bernal
