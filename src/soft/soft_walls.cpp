#include "soft/soft_walls.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "core/parallel.hpp"
#include "domain/wall_contacts.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_contacts = 32;
/// A wall with more facets than these near a sphere is asked at each push: that costs no more than to look at
/// those of so many that have come near.
constexpr std::size_t most_pieces = 512;
/// A centre keeps this share of its distance from a facet when it moves towards it.
constexpr double kept = 0.1;
/// A centre nearer to a facet than so many units of the coordinates does not approach it at all.
constexpr double units_kept = 64;
/// How far from the wall a sphere is told apart from one that is farther, in skins.
constexpr double far_reach = 3;
constexpr std::size_t groups_a_task = 64;
/// In radii, see SoftWalls.
constexpr double leeway = 0.02;

/// Takes back all but a share of the way.
void shorten(SoftSphere& to, const SoftSphere& from, double share) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto steps = static_cast<std::int32_t>(share * steps_between(from, to, k));
    to.x[k] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(from.x[k]) + static_cast<std::uint32_t>(steps));
  }
}

}  // namespace

SoftWalls::SoftWalls(const Container& container, const Vector<3>& corner, const Vector<3>& unit,
                     std::size_t spheres)
    : container_(container),
      repeats_(container.boundary().repeats()),
      inset_(container.inset()),
      corner_(corner),
      unit_(unit),
      float_unit_{static_cast<float>(unit[0]), static_cast<float>(unit[1]), static_cast<float>(unit[2])},
      resolution_(unit.maxCoeff()),
      stands_(spheres),
      views_(spheres) {}

Vector<3> SoftWalls::place(const SoftSphere& s) const {
  Vector<3> p;
  for (int k = 0; k < 3; ++k) p[k] = corner_[k] + unit_[k] * static_cast<std::uint32_t>(s.x[k]);
  return p;
}

Vector<3> SoftWalls::way_between(const SoftSphere& from, const SoftSphere& to) const {
  return unit_.cwiseProduct(
      Vector<3>(steps_between(from, to, 0), steps_between(from, to, 1), steps_between(from, to, 2)));
}

void SoftWalls::stop_strays(std::vector<SoftSphere>& spheres, const std::vector<SoftSphere>& built_at,
                            const std::vector<std::uint32_t>& ids) const {
  const std::size_t groups = first_.size() - 1;
  parallel_ranges(groups, groups_a_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      std::array<bool, lanes> is_near{};
      for (std::uint32_t n = first_[g]; n < first_[g + 1]; ++n) is_near[near_[n].lane] = true;
      for (std::size_t l = 0; l < lanes; ++l) {
        const std::size_t p = lanes * g + l;
        if (spheres[p].r > 0 && !is_near[l]) stop_stray(spheres[p], built_at[p], stands_[ids[p]]);
      }
    }
  });
}

void SoftWalls::stop_stray(SoftSphere& sphere, const SoftSphere& built_at, const Stand& stand) const {
  // Then it was not near, and no farther than that it has not come through.
  constexpr double surely = 0.999;
  const auto near = static_cast<float>(surely * (radius_at_wall(built_at) + skin_));
  if (step(built_at.x, sphere.x).squared() < near * near) return;
  const Vector<3> from = place(built_at);
  const Vector<3> move = way_between(built_at, sphere);
  const double length = move.norm();
  if (!(length > 0)) return;
  if (length < stand.clearance - way(stand.at, from).norm()) return;
  const double free = container_.first_contact(from, 0, move / length, length);
  if (free < length) shorten(sphere, built_at, (1 - kept) * free / length);
}

/// Whether a wall is nearer to the centre than r + skin; the view then knows all that is.
bool SoftWalls::look(const Vector<3>& at, double r, double skin, std::uint32_t id) {
  Stand& stand = stands_[id];
  const double near = r + skin, moved = way(stand.at, at).norm();
  if (stand.clearance - moved >= near) return false;
  View& view = views_[id];
  if (view.reach - moved >= near)
    return (view.is_fine || view.pieces.empty() ? stand.clearance : view.pieces.front().distance) - moved <
           near;
  view.pieces.clear();
  view.is_fine = false;
  view.reach = 0;
  stand = {at, container_.clearance_within(at, near + far_reach * skin - inset_) + inset_};
  if (stand.clearance >= near) return false;
  std::vector<NearFacet> facets;
  view.reach = near + skin;
  view.is_fine = !container_.few_facets_near(at, view.reach - inset_, most_pieces, facets);
  if (view.is_fine) return true;
  view.pieces.reserve(facets.size());
  for (const NearFacet& f : facets) view.pieces.push_back({f.distance + inset_, facets_.number_of(f.facet)});
  return !view.pieces.empty();
}

void SoftWalls::build(const std::vector<SoftSphere>& spheres, const std::vector<std::uint32_t>& ids,
                      float skin) {
  skin_ = skin;
  const std::size_t groups = spheres.size() / lanes;
  std::vector<Found> found((groups + groups_a_task - 1) / groups_a_task);
  first_.resize(groups + 1);
  parallel_for(found.size(), [&](std::size_t b) {
    for (std::size_t g = b * groups_a_task; g < std::min(groups, (b + 1) * groups_a_task); ++g) {
      for (std::uint32_t l = 0; l < lanes; ++l) {
        const SoftSphere& s = spheres[g * lanes + l];
        const std::uint32_t id = ids[g * lanes + l];
        if (s.r > 0 && look(place(s), radius_at_wall(s), skin, id)) add_near(l, id, s, found[b]);
      }
      first_[g + 1] = static_cast<std::uint32_t>(found[b].near.size());
    }
  });
  join(found);
}

/// What the tasks of `build` have found, one after the other.
void SoftWalls::join(const std::vector<Found>& found) {
  std::vector<Found::Ends> before(1);
  has_fine_ = false;
  for (const Found& part : found) {
    const Found::Ends& last = before.back();
    before.push_back({last.near + part.near.size(), last.until + part.until.size(),
                      last.least_until + part.least_until.size()});
    has_fine_ |= part.has_fine;
  }
  near_.resize(before.back().near);
  until_.resize(before.back().until);
  least_until_.resize(before.back().least_until);
  planes_.resize(most_planes * near_.size());
  ahead_.clear();
  first_[0] = 0;
  parallel_for(found.size(), [&](std::size_t b) {
    const auto at = [](auto& all, std::size_t k) { return all.begin() + static_cast<std::ptrdiff_t>(k); };
    std::ranges::copy(found[b].near, at(near_, before[b].near));
    std::ranges::copy(found[b].until, at(until_, before[b].until));
    std::ranges::copy(found[b].least_until, at(least_until_, before[b].least_until));
    for (std::size_t n = before[b].near; n < before[b + 1].near; ++n) {
      near_[n].first += static_cast<std::uint32_t>(before[b].until);
      near_[n].first_run += static_cast<std::uint32_t>(before[b].least_until);
    }
    for (std::size_t g = b * groups_a_task + 1; g < std::min(first_.size(), (b + 1) * groups_a_task + 1); ++g)
      first_[g] += static_cast<std::uint32_t>(before[b].near);
  });
}

void SoftWalls::add_near(std::uint32_t lane, std::uint32_t id, const SoftSphere& sphere, Found& found) const {
  const View& view = views_[id];
  NearSphere near{.lane = static_cast<std::uint16_t>(lane),
                  .is_fine = view.is_fine,
                  .id = id,
                  .first = static_cast<std::uint32_t>(found.until.size()),
                  .first_run = static_cast<std::uint32_t>(found.least_until.size()),
                  .last = place(sphere)};
  found.has_fine |= view.is_fine;
  const double moved = way(stands_[id].at, near.last).norm();
  near.beyond = (view.is_fine ? stands_[id].clearance : view.reach) - moved;
  for (const Piece& piece : view.pieces) {
    if (piece.distance - moved >= radius_at_wall(sphere) + skin_) {
      near.beyond = piece.distance - moved;
      break;
    }
    // Pieces come nearest first.
    if (near.count % run == 0) found.least_until.push_back(static_cast<float>(piece.distance - moved));
    found.until.push_back({static_cast<float>(piece.distance - moved), piece.facet});
    ++near.count;
  }
  found.near.push_back(near);
}

/// Appends what is nearer than `reach` among the pieces of a sphere; returns a distance that no wall is
/// nearer than.
double SoftWalls::look_through(const NearSphere& near, double reach, std::vector<WallContact>& contacts) {
  double free = near.beyond - near.way;
  for (std::uint32_t first = 0; first < near.count; first += run) {
    float& least = least_until_[near.first_run + first / run];
    if (least - near.way >= reach) {
      free = std::min(free, least - near.way);
      continue;
    }
    const std::uint32_t end = std::min(near.count, first + run);
    // Of a fine mesh facets come from far away in memory: they are on their way before they are needed.
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

/// Makes planes of the contacts that were found within `reach`, patch by patch, and leaves those that push.
/// Where there are too many there are none, and the sphere looks anew each time.
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

/// Looks at facets. Appends the contacts of a sphere; returns a distance that no wall is nearer than.
double SoftWalls::touch(std::uint32_t n, double r, std::vector<WallContact>& contacts) {
  const double reach = (1 + leeway) * r, free = look_through(near_[n], reach, contacts);
  take_for_planes(n, r, reach, contacts);
  return free;
}

/// The same of a sphere at a fine wall, where the container knows.
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

SoftWalls::Step SoftWalls::step(const std::int32_t* from, const std::int32_t* to) const {
  Step step;
  for (std::size_t k = 0; k < 3; ++k)
    step.x[k] =
        float_unit_[k] * static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(to[k]) -
                                                                      static_cast<std::uint32_t>(from[k])));
  return step;
}

/// What a sphere touches that has not gone far since facets were looked at. Returns false, with nothing done,
/// where that has to be done again.
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
    // The edge of a face is as deep as the face to the first order of the way, but pushes askew.
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
    const Vector<3> c = place(spheres[l]);
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
    const Vector<3> move = way_between(before, now), c = place(before);
    const double length = move.norm();
    if (!(length > 0)) continue;
    if (near.is_fine) {
      const double free = container_.first_contact(c, 0, move / length, length);
      if (free < length) shorten(now, before, (1 - kept) * free / length);
      continue;
    }
    const double gone = near.way + way(near.last, c).norm();
    double share = std::min(1.0, (1 - kept) * std::max(0.0, near.beyond - gone) / length);
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
