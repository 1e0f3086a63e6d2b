#include "settle/roller.hpp"

#include <limits>

namespace bernal {
namespace {

/// The longest step of a rolling sphere, in radii, and what is so short that who stopped it was there before.
constexpr double longest_step = 0.25, no_step = 1e-6;
constexpr int most_steps = 400, most_corrections = 12, most_guesses = 60;
/// Gaps, in skins: up to which an obstacle is a contact, what a sphere that meets one stops at, and how
/// exactly.
constexpr double touching = 1.5, met = 1, exactness = 0.2, least = 0.75, rounding = 1e-3;
/// Two contacts whose normals enclose a smaller angle (squared sine) make no line.
constexpr double no_line = 1e-14;

}  // namespace

/// The unit vector from the obstacle to the sphere, moved by the offset, and the gap between them.
Vector<3> Roller::from_obstacle(Obstacle k, const Vector<3>& offset, double& gap) const {
  if (k < mover_.count_) {
    const Vector<3> way = offset - Vector<3>(mover_.x_[k], mover_.y_[k], mover_.z_[k]);
    const double length = way.norm();
    gap = length - mover_.sum_[k];
    return way / length;
  }
  const Facet& facet = mover_.walls()[k - mover_.count_].facet;
  const Vector<3> place = mover_.ball().center + offset;
  gap = distance(facet, place) - mover_.ball().r;
  return (place - closest_point(facet, place)).normalized();
}

double Roller::gap_to(Obstacle k, const Vector<3>& offset) const {
  double gap;
  from_obstacle(k, offset, gap);
  return gap;
}

void Roller::find_contacts() {
  contacts_.clear();
  normals_.clear();
  stopper_at_ = SteepestWay::none;
  const double reach = touching * bed_.skin();
  const auto offer = [&](Obstacle k) {
    double gap;
    const Vector<3> normal = from_obstacle(k, Vector<3>::Zero(), gap);
    if (gap > reach) return;
    if (k == stopper_) stopper_at_ = contacts_.size();
    contacts_.push_back({k, gap});
    normals_.push_back(normal);
  };
  for (std::size_t k = 0; k < mover_.count_; ++k) {
    const double sum = mover_.sum_[k] + reach;
    const double squared =
        mover_.x_[k] * mover_.x_[k] + mover_.y_[k] * mover_.y_[k] + mover_.z_[k] * mover_.z_[k];
    if (squared <= sum * sum) offer(static_cast<Obstacle>(k));
  }
  const double moved = mover_.moved();
  const std::span<const NearFacet> walls = mover_.walls();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (walls[k].distance - moved > mover_.ball().r + reach) break;
    offer(static_cast<Obstacle>(mover_.count_ + k));
  }
}

/// The track of the steepest way down; none where nothing is steeper than `flattest_`.
Roller::Track Roller::steepest() const {
  const SteepestWay found = steepest_way(down_, normals_, stopper_at_);
  Track track;
  const double slope = found.way.norm();
  if (!(slope > flattest_)) return track;
  track.count = found.count;
  for (int k = 0; k < found.count; ++k)
    track.on[static_cast<std::size_t>(k)] = contacts_[found.held_by[static_cast<std::size_t>(k)]].obstacle;
  track.along = found.way / slope;
  return track;
}

/// Moves the offset to where the gaps to what the track is on are a skin. Returns whether that came to an
/// end.
bool Roller::put_back(const Track& track, Vector<3>& offset) const {
  const double aim = met * bed_.skin(), enough = rounding * bed_.skin();
  for (int k = 0; k < most_corrections; ++k) {
    double g, h = aim;
    const Vector<3> n = from_obstacle(track.on[0], offset, g);
    if (track.count == 1) {
      offset -= (g - aim) * n;
      if (std::abs(g - aim) <= enough) return true;
      continue;
    }
    const Vector<3> m = from_obstacle(track.on[1], offset, h);
    const double c = n.dot(m), squared_sine = std::max(n.cross(m).squaredNorm(), no_line);
    const double p = g - aim, q = h - aim;
    offset -= ((p - c * q) * n + (q - c * p) * m) / squared_sine;
    if (std::max(std::abs(p), std::abs(q)) <= enough) return true;
  }
  return false;
}

/// Where the track is after a step of length t.
bool Roller::at(const Track& track, double t, Vector<3>& offset) const {
  offset = t * track.along;
  return put_back(track, offset);
}

/// What the gap to an obstacle may not fall below; of walls that leave no play what it is.
double Roller::least_allowed(Obstacle k) const {
  const double skin = bed_.skin();
  for (const Contact& c : contacts_)
    if (c.obstacle == k)
      return c.gap < 0.5 * skin ? c.gap : std::clamp(c.gap - rounding * skin, 0.5 * skin, least * skin);
  return least * skin;
}

/// Of the obstacles that the track is not on, the one that a sphere moved by the offset is nearest to, if it
/// is nearer than it may be.
Roller::Nearest Roller::violated(const Track& track, const Vector<3>& offset) const {
  Nearest nearest{std::numeric_limits<double>::infinity(), 0};
  const auto offer = [&](Obstacle k, double gap) {
    if (track.is_on(k)) return;
    if (gap < nearest.gap && gap < least_allowed(k)) nearest = {gap, k};
  };
  const double reach = least * bed_.skin();
  for (std::size_t k = 0; k < mover_.count_; ++k) {
    const double x = mover_.x_[k] - offset[0], y = mover_.y_[k] - offset[1], z = mover_.z_[k] - offset[2];
    const double sum = mover_.sum_[k] + reach, squared = x * x + y * y + z * z;
    if (squared < sum * sum) offer(static_cast<Obstacle>(k), std::sqrt(squared) - mover_.sum_[k]);
  }
  const double r = mover_.ball().r, moved = mover_.moved() + offset.norm();
  const Vector<3> place = mover_.ball().center + offset;
  const std::span<const NearFacet> walls = mover_.walls();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    if (walls[k].distance - moved > r + reach) break;
    offer(static_cast<Obstacle>(mover_.count_ + k), distance(walls[k].facet, place) - r);
  }
  return nearest;
}

/// The longest step, at most t, after which the gap to the obstacle is a skin; there it is smaller.
double Roller::until_contact(const Track& track, double t, Obstacle k, Vector<3>& offset) const {
  const double aim = met * bed_.skin(), enough = exactness * bed_.skin();
  double low = 0, high = t, at_low = gap_to(k, Vector<3>::Zero()) - aim, at_high = gap_to(k, offset) - aim;
  int side = 0;
  for (int guess = 0; guess < most_guesses && at_low > 0; ++guess) {
    const double linear = (low * at_high - high * at_low) / (at_high - at_low);
    const double middle = guess % 8 == 7 || !(linear > low && linear < high) ? 0.5 * (low + high) : linear;
    if (!at(track, middle, offset)) return 0;
    const double now = gap_to(k, offset) - aim;
    if (std::abs(now) <= enough) return middle;
    if (now > 0) {
      low = middle;
      at_low = now;
      if (side == 1) at_high *= 0.5;
      side = 1;
    } else {
      high = middle;
      at_high = now;
      if (side == -1) at_low *= 0.5;
      side = -1;
    }
  }
  return at(track, low, offset) ? low : 0;
}

/// How far the sphere may go along u before its box ends.
double Roller::room_in_box(const Vector<3>& u) const {
  FreePath path{std::numeric_limits<double>::infinity()};
  mover_.limit_by_box(u, path);
  return path.length;
}

/// The sine of the angle at which the track leads down where the sphere is moved by the offset.
double Roller::slope(const Track& track, const Vector<3>& offset) const {
  double gap;
  const Vector<3> n = from_obstacle(track.on[0], offset, gap);
  Vector<3> u = track.along - track.along.dot(n) * n;
  if (track.count > 1) {
    const Vector<3> line = n.cross(from_obstacle(track.on[1], offset, gap));
    u = track.along.dot(line) * line;
  }
  return u.dot(down_) / u.norm();
}

/// Of a step of length t that led to the offset and up again: the one that led to the lowest place.
double Roller::to_lowest(const Track& track, double t, Vector<3>& offset) const {
  double low = 0, high = t, at_low = track.along.dot(down_), at_high = slope(track, offset);
  for (int guess = 0; guess < most_guesses && at_high < 0; ++guess) {
    const double middle = (low * at_high - high * at_low) / (at_high - at_low);
    if (!at(track, middle, offset)) return 0;
    const double now = slope(track, offset);
    if (std::abs(now) < 0.5 * level) return middle;
    if (now > 0) {
      low = middle;
      at_low = now;
      at_high *= 0.5;
    } else {
      high = middle;
      at_high = now;
    }
  }
  return at(track, low, offset) ? low : 0;
}

bool Roller::is_in_box(const Vector<3>& offset) const {
  const double length = offset.norm();
  return !(length > 0) || length <= room_in_box(offset / length);
}

/// The longest step along the track: in a narrow tube the place of the sphere turns about the axis soon.
double Roller::longest_on(const Track& track) const {
  const double r = mover_.ball().r;
  double longest = longest_step * r;
  for (int k = 0; k < track.count; ++k) {
    const Obstacle on = track.on[static_cast<std::size_t>(k)];
    if (on < mover_.count_) continue;
    const Facet& wall = mover_.walls()[on - mover_.count_].facet;
    if (wall.kind == Facet::Kind::cylinder || wall.kind == Facet::Kind::sphere)
      longest = std::min(longest, std::max(0.5 * (wall.radius - r), no_step * no_step * r));
  }
  return longest;
}

/// One step along the track, of at most the length `step`, which becomes what to try the next time. Returns
/// false where the sphere can make none, mostly because its bounding box ends.
bool Roller::step_along(const Track& track, double& step) {
  const double r = mover_.ball().r, room = room_in_box(track.along);
  if (room < no_step * r) return false;
  Vector<3> offset;
  double t = std::min({step, room, longest_on(track)});
  while (!at(track, t, offset) || offset.dot(track.along) <= 0 || !is_in_box(offset)) {
    t *= 0.5;
    if (t < no_step * no_step * r) return false;
  }
  if (slope(track, offset) < 0) t = to_lowest(track, t, offset);
  for (Nearest nearest = violated(track, offset); t > 0 && std::isfinite(nearest.gap);
       nearest = violated(track, offset)) {
    t = until_contact(track, t, nearest.obstacle, offset);
    stopper_ = nearest.obstacle;
  }
  step = std::clamp(2 * t, no_step * r, longest_step * r);
  const double length = offset.norm();
  if (!(t > 0 && length > 0)) return stopper_ != none;  // what would only be put back stays where it is
  if (!is_in_box(offset)) return false;
  if (length > no_step * r) stopper_ = none;
  mover_.advance(offset / length, length);
  return true;
}

double Roller::roll(Bed::Id i) {
  mover_.pick(i);
  stopper_ = none;
  const Vector<3> start = mover_.ball().center;
  double step = longest_step * mover_.ball().r;
  for (int k = 0; k < most_steps; ++k) {
    find_contacts();
    const Track track = steepest();
    if (track.along.isZero(0)) break;
    if (track.count > 0) {
      if (step_along(track, step)) continue;
      break;
    }
    const FreePath path = mover_.free_path(down_, std::numeric_limits<double>::infinity());
    mover_.advance(down_, path.length);
    if (path.end == FreePath::End::box) break;
  }
  return (mover_.ball().center - start).norm();
}

}  // namespace bernal
