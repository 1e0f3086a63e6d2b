#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
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

/// What is deeper than this along the normal of the nearer contact, n·(c - x), it pushes for: if it is nearer
/// than r, that is within the angle.
inline double spoken_depth(const WallContact& nearer, double r) {
  return std::min(nearer.distance - in_plane * r, one_patch * r);
}

/// Whether it pushes for every point of the box that is no nearer than itself, but nearer than r. c is the
/// ball's centre.
inline bool speaks_for_all(const WallContact& nearer, const Bounds<3>& box, const Vector<3>& c, double r) {
  const Vector<3> half = 0.5 * box.size(), w = c - box.center();
  const double along = nearer.normal.dot(w);
  if (along - nearer.normal.cwiseAbs().dot(half) > spoken_depth(nearer, r)) return true;
  // The box in the ball around it, seen from c under twice the angle whose sine is this.
  const double squared = w.squaredNorm(), squared_ball = half.squaredNorm();
  if (!(along > 0) || squared_ball >= squared) return false;
  const double across = std::sqrt(std::max(0.0, squared - along * along));
  return along * std::sqrt(squared - squared_ball) - across * std::sqrt(squared_ball) > one_patch * squared;
}

/// Whether one of the contacts, all of them nearer, pushes for it.
inline bool is_spoken_for(std::span<const WallContact> nearer, const WallContact& contact, double r) {
  return std::ranges::any_of(nearer, [&](const WallContact& known) { return speaks_for(known, contact, r); });
}

/// Leaves of the contacts from number `first` on those that push for themselves, nearest first.
inline void leave_distinct(std::vector<WallContact>& contacts, double r, std::size_t first = 0) {
  const auto begin = contacts.begin() + static_cast<std::ptrdiff_t>(first);
  std::sort(begin, contacts.end(),
            [](const WallContact& a, const WallContact& b) { return a.distance < b.distance; });
  auto end = begin;
  for (auto contact = begin; contact != contacts.end(); ++contact)
    if (!is_spoken_for({begin, end}, *contact, r)) *end++ = *contact;
  contacts.erase(end, contacts.end());
}

}  // namespace bernal
