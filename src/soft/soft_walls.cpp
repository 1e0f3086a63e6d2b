#include "soft/soft_walls.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace bernal {
namespace {

/// With more facets near a sphere, the container is asked for each push: this costs no more than the
/// distances from so many facets.
constexpr std::size_t most_pieces = 512;
/// Up to how far from the reach of a sphere its clearance is computed exactly, in skins.
constexpr double far_reach = 3;
constexpr std::size_t groups_a_task = 64;

}  // namespace

SoftWalls::SoftWalls(const Container& container, const Vector<3>& corner, const Vector<3>& unit,
                     std::size_t spheres)
    : container_(container),
      repeats_(container.boundary().repeats()),
      varies_(repeats_ && container.kind() == "mesh"),
      inset_(container.inset()),
      corner_(corner),
      unit_(unit),
      float_unit_{static_cast<float>(unit[0]), static_cast<float>(unit[1]), static_cast<float>(unit[2])},
      resolution_(unit.maxCoeff()),
      stands_(spheres),
      views_(spheres) {}

Vector<3> SoftWalls::way_between(const SoftSphere& from, const SoftSphere& to) const {
  return unit_.cwiseProduct(
      Vector<3>(steps_between(from, to, 0), steps_between(from, to, 1), steps_between(from, to, 2)));
}

void SoftWalls::shorten(SoftSphere& to, const SoftSphere& from, double share) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto steps = static_cast<std::int32_t>(share * steps_between(from, to, k));
    to.x[k] =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(from.x[k]) + static_cast<std::uint32_t>(steps));
  }
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
  // It was not near a wall, so a move no longer than this has not passed one.
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

/// Returns whether a wall is nearer to the centre than r + skin. If so, the view has all facets that near.
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

/// Joins what the tasks of `build` have found.
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
                  .built_at = seen_from(id, place(sphere))};
  near.last = near.built_at;
  found.has_fine |= view.is_fine;
  const double moved = way(stands_[id].at, near.built_at).norm();
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

}  // namespace bernal
