#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bernal/domain/container.hpp"

namespace bernal {

// Which contacts of a ball with a wall push it for themselves. Of a smooth patch only the nearest does, and
// so of a face in many triangles and of its edges that are no nearer: how a wall is cut into facets makes no
// difference.

/// Cosine of 25°: pushes that agree so well come from one smooth patch.
constexpr double one_patch = 0.9;
/// In radii: points nearer than this to a plane are in it. Distances are good to some 1e-11.
constexpr double in_plane = 1e-6;

/// Whether the nearer contact of a ball of radius r pushes for the other one: one of the same smooth patch,
/// or one whose point is not in front of the plane in which the nearer one touches: the rest of a face in
/// many triangles, or the edge at its end.
inline bool speaks_for(const WallContact& nearer, const WallContact& contact, double r) {
  const double cosine = nearer.normal.dot(contact.normal);
  return cosine > one_patch || cosine * contact.distance > nearer.distance - in_plane * r;
}

/// Whether it does so for every point of the box that is no nearer than itself. c is the ball's centre.
inline bool speaks_for_all(const WallContact& nearer, const Bounds<3>& box, const Vector<3>& c, double r) {
  const Vector<3> half = 0.5 * box.size(), w = c - box.center();
  const double along = nearer.normal.dot(w);
  if (along - nearer.normal.cwiseAbs().dot(half) > nearer.distance - in_plane * r) return true;
  // The box in the ball around it, seen from c under twice the angle whose sine is this.
  const double squared = w.squaredNorm(), squared_ball = half.squaredNorm();
  if (!(along > 0) || squared_ball >= squared) return false;
  const double across = std::sqrt(std::max(0.0, squared - along * along));
  return along * std::sqrt(squared - squared_ball) - across * std::sqrt(squared_ball) > one_patch * squared;
}

/// The contacts of one ball that push for themselves, as they are found in any order: each that is found
/// drives out those farther ones that it speaks for.
class DistinctContacts {
 public:
  /// Appends to `out`, which outlives this.
  DistinctContacts(double r, std::vector<WallContact>& out) : r_(r), first_(out.size()), out_(out) {}

  void add(const WallContact& contact) {
    const auto begin = out_.begin() + static_cast<std::ptrdiff_t>(first_);
    for (auto other = begin; other != out_.end(); ++other)
      if (other->distance <= contact.distance && speaks_for(*other, contact, r_)) return;
    out_.erase(std::remove_if(begin, out_.end(),
                              [&](const WallContact& other) {
                                return other.distance > contact.distance && speaks_for(contact, other, r_);
                              }),
               out_.end());
    out_.push_back(contact);
  }

  template <class Holds>
  bool any(const Holds& holds) const {
    return std::any_of(out_.begin() + static_cast<std::ptrdiff_t>(first_), out_.end(), holds);
  }

  /// Nearest first.
  void sort() {
    std::sort(out_.begin() + static_cast<std::ptrdiff_t>(first_), out_.end(),
              [](const WallContact& a, const WallContact& b) { return a.distance < b.distance; });
  }

 private:
  double r_;
  std::size_t first_;
  std::vector<WallContact>& out_;
};

}  // namespace bernal
