// What the walls that `SoftWalls::build` has found do to spheres in a sweep.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/parallel.hpp"
#include "domain/wall_contacts.hpp"
#include "soft/soft_walls.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_contacts = 32;
/// A centre nearer to a facet than this number of units of the coordinates does not approach it.
constexpr double units_kept = 64;
/// In radii, see SoftWalls.
constexpr double leeway = 0.02;

}  // namespace

/// Appends the contacts nearer than `reach` among the pieces of a sphere. Returns a lower bound of the
/// distance from all walls.
double SoftWalls::look_through(const NearSphere& near, double reach, std::vector<WallContact>& contacts) {
  double free = beyond(near, near.last);
  for (std::uint32_t first = 0; first < near.count; first += run) {
    float& least = least_until_[near.first_run + first / run];
    if (least - near.way >= reach) {
      free = std::min(free, least - near.way);
      continue;
    }
    const std::uint32_t end = std::min(near.count, first + run);
    // The facets of a fine mesh are far apart in memory: they are prefetched.
    std::array<std::uint32_t, run> touchable;
    std::size_t count = 0;
    for (std::uint32_t k = near.first + first; k < near.first + end; ++k) {
      if (until_[k].until - near.way >= reach) {
        free = std::min(free, until_[k].until - near.way);
        continue;
      }
      touchable[count++] = k;
      facets_.fetch(until_[k].facet);
    }
    for (const std::uint32_t k : std::span(touchable).first(count)) {
      const Vector<3> away = facets_.offset(until_[k].facet, near.last);
      const double d = away.norm();
      until_[k].until = static_cast<float>(d + near.way);
      free = std::min(free, d);
      if (!(d < reach && d > 0)) continue;
      if (contacts.size() == most_contacts) leave_distinct(contacts, reach);
      if (contacts.size() < most_contacts) contacts.push_back({away / d, d});
    }
    least = std::numeric_limits<float>::infinity();
    for (std::uint32_t k = first; k < end; ++k) least = std::min(least, until_[near.first + k].until);
  }
  return free;
}

/// Makes planes of the contacts within `reach`, patch by patch, and keeps the contacts that push. If there
/// are too many for planes, the sphere computes distances in every sweep.
void SoftWalls::take_for_planes(std::uint32_t n, double r, double reach, std::vector<WallContact>& contacts) {
  NearSphere& near = near_[n];
  near.seen_to = contacts.size() <= most_planes ? static_cast<float>(reach) : 0;
  near.planes = 0;
  if (near.seen_to > 0) {
    Plane* planes = planes_.data() + most_planes * n;
    std::sort(contacts.begin(), contacts.end(),
              [](const WallContact& a, const WallContact& b) { return a.distance < b.distance; });
    std::array<std::uint32_t, most_planes> speaker;  // of each contact
    for (std::uint32_t k = 0; k < contacts.size(); ++k) {
      speaker[k] = k;
      for (std::uint32_t j = 0; j < k && speaker[k] == k; ++j)
        if (speaker[j] == j && speaks_for(contacts[j], contacts[k], r)) speaker[k] = j;
    }
    for (std::uint32_t j = 0; j < contacts.size(); ++j) {
      if (speaker[j] != j) continue;
      for (std::uint32_t k = j; k < contacts.size(); ++k)
        if (speaker[k] == j)
          planes[near.planes++] = {
              {static_cast<float>(contacts[k].normal[0]), static_cast<float>(contacts[k].normal[1]),
               static_cast<float>(contacts[k].normal[2])},
              static_cast<float>(contacts[k].distance),
              j};
    }
  }
  std::erase_if(contacts, [r](const WallContact& contact) { return !(contact.distance < r); });
  leave_distinct(contacts, r);
}

/// Appends the contacts of a sphere, from its facets. Returns a lower bound of the distance from all walls.
double SoftWalls::touch(std::uint32_t n, double r, std::vector<WallContact>& contacts) {
  const double reach = (1 + leeway) * r, free = look_through(near_[n], reach, contacts);
  take_for_planes(n, r, reach, contacts);
  return free;
}

/// The same for a sphere at a fine wall, from the container.
double SoftWalls::ask(NearSphere& near, double r, std::vector<WallContact>& contacts) const {
  if (near.beyond - near.way >= r) return near.beyond - near.way;
  container_.contacts(near.last, r - inset_, contacts);
  for (WallContact& contact : contacts) contact.distance += inset_;
  const double nearest = contacts.empty()
                             ? container_.clearance_within(near.last, r + skin_ - inset_) + inset_
                             : contacts.front().distance;
  near.beyond = nearest + near.way;
  return nearest;
}

void SoftWalls::push_ahead(const std::vector<SoftSphere>& spheres) {
  if (!has_fine_) return;
  ahead_.resize(first_.size() - 1);
  parallel_for(ahead_.size(), [&](std::size_t g) {
    if (near(g)) work_out(g, spheres.data() + lanes * g, ahead_[g]);
  });
}

void SoftWalls::push(std::size_t group, const SoftSphere* spheres, WallPush& out) {
  if (ahead_.empty())
    work_out(group, spheres, out);
  else
    out = ahead_[group];
}

/// Adds the pushes on a sphere from its planes. Returns false, and does nothing, if it has moved too far for
/// them.
bool SoftWalls::push_by_planes(std::uint32_t n, const SoftSphere& sphere, WallPush& out) const {
  const NearSphere& near = near_[n];
  const auto r = static_cast<float>(radius_at_wall(sphere));
  const Step gone = step(near.seen_from.data(), sphere.x);
  const float squared = gone.squared(), alone = near.free - r;  // there is no contact as far as that
  const std::uint16_t l = near.lane;
  if (alone > 0 && squared < alone * alone) {
    out.free[l] = near.free - std::sqrt(squared);
    return true;
  }
  const float farthest = std::min(static_cast<float>(leeway) * r, near.seen_to - r);
  if (!(farthest > 0 && squared <= farthest * farthest)) return false;
  out.free[l] = near.free - std::sqrt(squared);
  const auto at = [&](const Plane& plane) {
    return plane.distance +
           (plane.normal[0] * gone.x[0] + plane.normal[1] * gone.x[1] + plane.normal[2] * gone.x[2]);
  };
  const Plane* plane = planes_.data() + most_planes * n;
  for (const Plane* const end = plane + near.planes; plane < end;) {
    // To first order in the move, the edge of a face is as deep as the face, but pushes in another direction.
    const Plane* deepest = plane;
    const float as_deep = squared / plane->distance;
    float least = at(*plane);
    for (const std::uint32_t patch = plane->patch; plane < end && plane->patch == patch; ++plane) {
      const float d = at(*plane);
      if (d < least - as_deep) {
        least = d;
        deepest = plane;
      }
    }
    if (!(least < r && least > 0)) continue;
    const float depth = r - least, ratio = depth / r;
    out.x[l] += depth * deepest->normal[0];
    out.y[l] += depth * deepest->normal[1];
    out.z[l] += depth * deepest->normal[2];
    out.squares[l] += ratio * ratio;
    out.depth[l] += depth;
    out.worst[l] = std::max(out.worst[l], ratio);
    ++out.contacts[l];
  }
  return true;
}

void SoftWalls::work_out(std::size_t group, const SoftSphere* spheres, WallPush& out) {
  out = {};
  std::copy(spheres, spheres + lanes, out.before.begin());
  thread_local std::vector<WallContact> contacts;
  for (std::uint32_t n = first_[group]; n < first_[group + 1]; ++n) {
    NearSphere& near = near_[n];
    const std::uint16_t l = near.lane;
    if (!anew_ && push_by_planes(n, spheres[l], out)) continue;
    const Vector<3> c = seen_from(near.id, place(spheres[l]));
    const double r = radius_at_wall(spheres[l]);
    near.way += way(near.last, c).norm();
    near.last = c;
    std::copy(spheres[l].x, spheres[l].x + 3, near.seen_from.begin());
    contacts.clear();
    out.free[l] = near.is_fine ? ask(near, r, contacts) : touch(n, r, contacts);
    near.free = static_cast<float>(out.free[l]);
    Vector<3> sum = Vector<3>::Zero();
    for (const WallContact& contact : contacts) {
      const double depth = r - contact.distance, ratio = depth / r;
      sum += depth * contact.normal;
      out.squares[l] += static_cast<float>(ratio * ratio);
      out.depth[l] += static_cast<float>(depth);
      out.worst[l] = std::max(out.worst[l], static_cast<float>(ratio));
    }
    out.x[l] = static_cast<float>(sum[0]);
    out.y[l] = static_cast<float>(sum[1]);
    out.z[l] = static_cast<float>(sum[2]);
    out.contacts[l] = static_cast<float>(contacts.size());
  }
}

void SoftWalls::guard(std::size_t group, const WallPush& push, SoftSphere* spheres) const {
  for (std::uint32_t n = first_[group]; n < first_[group + 1]; ++n) {
    const NearSphere& near = near_[n];
    SoftSphere& now = spheres[near.lane];
    const SoftSphere& before = push.before[near.lane];
    const auto enough = static_cast<float>((1 - kept) * push.free[near.lane]);
    if (enough > 0 && step(before.x, now.x).squared() <= enough * enough) continue;
    const Vector<3> move = way_between(before, now), c = seen_from(near.id, place(before));
    const double length = move.norm();
    if (!(length > 0)) continue;
    if (near.is_fine) {
      const double free = container_.first_contact(c, 0, move / length, length);
      if (free < length) shorten(now, before, (1 - kept) * free / length);
      continue;
    }
    const double gone = near.way + way(near.last, c).norm();
    double share = std::min(1.0, (1 - kept) * std::max(0.0, beyond(near, c)) / length);
    for (std::uint32_t k = 0; k < near.count && share > 0; ++k) {
      if (k % run == 0 && (1 - kept) * (least_until_[near.first_run + k / run] - gone) > length) {
        k += run - 1;
        continue;
      }
      const auto& [until, facet] = until_[near.first + k];
      if ((1 - kept) * (until - gone) > length) continue;
      const Vector<3> away = facets_.offset(facet, c);
      const double d = away.norm();
      if (!(d > 0)) {
        share = 0;
        break;
      }
      const double after = facets_.distance_after(facet, c, away, d, move);
      if (after >= d || (after >= kept * d && after >= units_kept * resolution_)) continue;
      share = std::min(share, d <= units_kept * resolution_ ? 0.0 : (1 - kept) * d / (d - after));
    }
    if (share < 1) shorten(now, before, share);
  }
}

}  // namespace bernal
