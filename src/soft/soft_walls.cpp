#include "soft/soft_walls.hpp"

#include <algorithm>

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

/// p minus the nearest point of the facet; for a facet of an analytic container p is on its inner side.
Vector<3> offset(const std::variant<Facet, PreparedTriangle>& piece, const Vector<3>& p) {
  if (const auto* triangle = std::get_if<PreparedTriangle>(&piece)) return triangle->offset(p);
  return p - closest_point(std::get<Facet>(piece), p);
}

/// A lower bound of the distance from the facet after a straight move by `move` from p, whose offset is
/// `from`: concave along the way for the curved walls, whose inside is convex; for a triangle the distance
/// from the plane through its nearest point, which has all of it behind.
double distance_after(const std::variant<Facet, PreparedTriangle>& piece, const Vector<3>& p,
                      const Vector<3>& from, double distance_before, const Vector<3>& move) {
  if (const auto* facet = std::get_if<Facet>(&piece)) return distance(*facet, p + move);
  return distance_before + move.dot(from) / distance_before;
}

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
      resolution_(unit.maxCoeff()),
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
  std::vector<bool> near(spheres.size(), false);
  for (std::size_t g = 0; g + 1 < first_.size(); ++g)
    for (std::uint32_t n = first_[g]; n < first_[g + 1]; ++n) near[g * lanes + near_[n].lane] = true;
  for (std::size_t p = 0; p < spheres.size(); ++p) {
    if (!(spheres[p].r > 0) || near[p]) continue;
    const Vector<3> from = place(built_at[p]);
    const Vector<3> move = way_between(built_at[p], spheres[p]);
    const double length = move.norm();
    if (!(length > 0)) continue;
    const View& view = views_[ids[p]];
    if (length < view.clearance - way(view.at, from).norm()) continue;
    const double free = container_.first_contact(from, 0, move / length, length);
    if (free < length) shorten(spheres[p], built_at[p], (1 - kept) * free / length);
  }
}

/// Whether a wall is nearer to the centre than r + skin; the view then knows all that is.
bool SoftWalls::look(const Vector<3>& at, double r, double skin, View& view) const {
  const double near = r + skin, moved = way(view.at, at).norm();
  if (view.clearance - moved >= near) return false;
  if (view.reach - moved >= near)
    return (view.is_fine ? view.clearance : view.pieces.front().distance) - moved < near;
  view.at = at;
  view.pieces.clear();
  view.is_fine = false;
  view.reach = 0;
  view.clearance = container_.clearance_within(at, near + far_reach * skin - inset_) + inset_;
  if (view.clearance >= near) return false;
  std::vector<NearFacet> facets;
  view.reach = near + skin;
  view.is_fine = !container_.few_facets_near(at, view.reach - inset_, most_pieces, facets);
  if (view.is_fine) return true;
  view.pieces.reserve(facets.size());
  for (const NearFacet& f : facets) {
    if (f.facet.kind == Facet::Kind::triangle)
      view.pieces.push_back({f.distance + inset_, PreparedTriangle(f.facet.a, f.facet.b, f.facet.c)});
    else
      view.pieces.push_back({f.distance + inset_, f.facet});
  }
  return !view.pieces.empty();
}

void SoftWalls::build(const std::vector<SoftSphere>& spheres, const std::vector<std::uint32_t>& ids,
                      float skin) {
  skin_ = skin;
  const std::size_t groups = spheres.size() / lanes;
  std::vector<std::uint16_t> near_lanes(groups, 0);
  parallel_for((groups + groups_a_task - 1) / groups_a_task, [&](std::size_t b) {
    for (std::size_t g = b * groups_a_task; g < std::min(groups, (b + 1) * groups_a_task); ++g) {
      for (std::size_t l = 0; l < lanes; ++l) {
        const SoftSphere& s = spheres[g * lanes + l];
        if (s.r > 0 && look(place(s), radius_at_wall(s), skin, views_[ids[g * lanes + l]]))
          near_lanes[g] = static_cast<std::uint16_t>(near_lanes[g] | 1u << l);
      }
    }
  });
  first_.assign(1, 0);
  near_.clear();
  until_.clear();
  least_until_.clear();
  has_fine_ = false;
  ahead_.clear();
  for (std::size_t g = 0; g < groups; ++g) {
    for (std::uint32_t l = 0; l < lanes; ++l) {
      if (near_lanes[g] >> l & 1) add_near(l, ids[g * lanes + l], spheres[g * lanes + l]);
    }
    first_.push_back(static_cast<std::uint32_t>(near_.size()));
  }
}

void SoftWalls::add_near(std::uint32_t lane, std::uint32_t id, const SoftSphere& sphere) {
  const View& view = views_[id];
  NearSphere near{lane,
                  id,
                  static_cast<std::uint32_t>(until_.size()),
                  static_cast<std::uint32_t>(least_until_.size()),
                  0,
                  place(sphere),
                  0,
                  0};
  has_fine_ |= view.is_fine;
  const double moved = way(view.at, near.last).norm();
  near.beyond = (view.is_fine ? view.clearance : view.reach) - moved;
  for (const Piece& piece : view.pieces) {
    if (piece.distance - moved >= radius_at_wall(sphere) + skin_) {
      near.beyond = piece.distance - moved;
      break;
    }
    // Pieces come nearest first.
    if (near.count % run == 0) least_until_.push_back(static_cast<float>(piece.distance - moved));
    until_.push_back(static_cast<float>(piece.distance - moved));
    ++near.count;
  }
  near_.push_back(near);
}

/// Appends the contacts of a sphere among its pieces; returns a distance that no wall is nearer than.
double SoftWalls::look_through(const NearSphere& near, double r, std::vector<WallContact>& contacts) {
  const std::vector<Piece>& pieces = views_[near.id].pieces;
  double free = near.beyond - near.way;
  for (std::uint32_t first = 0; first < near.count; first += run) {
    float& least = least_until_[near.first_run + first / run];
    if (least - near.way >= r) {
      free = std::min(free, least - near.way);
      continue;
    }
    const std::uint32_t end = std::min(near.count, first + run);
    for (std::uint32_t k = first; k < end; ++k) {
      float& until = until_[near.first + k];
      if (until - near.way >= r) {
        free = std::min(free, until - near.way);
        continue;
      }
      const Vector<3> away = offset(pieces[k].facet, near.last);
      const double d = away.norm();
      until = static_cast<float>(d + near.way);
      free = std::min(free, d);
      if (!(d < r && d > 0)) continue;
      if (contacts.size() == most_contacts) leave_distinct(contacts, r);
      if (contacts.size() < most_contacts) contacts.push_back({away / d, d});
    }
    least = *std::min_element(until_.begin() + near.first + first, until_.begin() + near.first + end);
  }
  leave_distinct(contacts, r);
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

void SoftWalls::work_out(std::size_t group, const SoftSphere* spheres, WallPush& out) {
  out = {};
  std::copy(spheres, spheres + lanes, out.before.begin());
  thread_local std::vector<WallContact> contacts;
  for (std::uint32_t n = first_[group]; n < first_[group + 1]; ++n) {
    NearSphere& near = near_[n];
    const std::uint32_t l = near.lane;
    const Vector<3> c = place(spheres[l]);
    const double r = radius_at_wall(spheres[l]);
    near.way += way(near.last, c).norm();
    near.last = c;
    contacts.clear();
    out.free[l] = views_[near.id].is_fine ? ask(near, r, contacts) : look_through(near, r, contacts);
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
    const Vector<3> move = way_between(before, now);
    const double length = move.norm();
    if (length <= (1 - kept) * push.free[near.lane]) continue;
    const Vector<3>& c = near.last;
    if (views_[near.id].is_fine) {
      const double free = container_.first_contact(c, 0, move / length, length);
      if (free < length) shorten(now, before, (1 - kept) * free / length);
      continue;
    }
    const std::vector<Piece>& pieces = views_[near.id].pieces;
    double share = std::min(1.0, (1 - kept) * std::max(0.0, near.beyond - near.way) / length);
    for (std::uint32_t k = 0; k < near.count && share > 0; ++k) {
      if (k % run == 0 && (1 - kept) * (least_until_[near.first_run + k / run] - near.way) > length) {
        k += run - 1;
        continue;
      }
      if ((1 - kept) * (until_[near.first + k] - near.way) > length) continue;
      const Vector<3> away = offset(pieces[k].facet, c);
      const double d = away.norm();
      if (!(d > 0)) {
        share = 0;
        break;
      }
      const double after = distance_after(pieces[k].facet, c, away, d, move);
      if (after >= d || (after >= kept * d && after >= units_kept * resolution_)) continue;
      share = std::min(share, d <= units_kept * resolution_ ? 0.0 : (1 - kept) * d / (d - after));
    }
    if (share < 1) shorten(now, before, share);
  }
}

}  // namespace bernal
