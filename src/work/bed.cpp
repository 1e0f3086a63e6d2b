#include "work/bed.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/parallel.hpp"
#include "near/end_to_end.hpp"
#include "work/holes.hpp"

namespace bernal {
namespace {

constexpr std::size_t block_size = 1024;

template <class T>
void permute(std::vector<T>& values, const std::vector<Bed::Id>& order) {
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const Bed::Id i : order) sorted.push_back(values[i]);
  values.swap(sorted);
}

}  // namespace

Bed::Bed(const Container& container, double r_min, double r_max, std::size_t expected, EffectLog& effects)
    : container_(container),
      made_for_{r_min, r_max, expected},
      effects_(effects),
      repeats_(container.boundary().repeats()),
      skin_(tolerance::skin(r_min, container.resolution())),
      longest_buffer_(std::numeric_limits<double>::infinity()),
      places_(container),
      grid_(container.bounds(), container.boundary(), r_min, r_max, expected) {
  for (int k = 0; k < 3; ++k) {
    if (!container.boundary().repeats(k)) continue;
    const double period = container.boundary().edges[k];
    if (period < least_period * 2 * r_max)
      throw Error(ErrorCode::bad_argument, "a period is shorter than three of the largest diameters");
    longest_buffer_ = std::min(longest_buffer_, (0.5 * period - 2 * r_max - 4 * skin_) / 4);
  }
}

double Bed::potential(const Vector<3>& direction) const {
  double sum = 0, weight = 0;
  for (const Ball& b : balls_) {
    const double mass = dimension() == 2 ? b.r * b.r : b.r * b.r * b.r;
    sum -= mass * direction.dot(b.center);
    weight += mass;
  }
  return weight > 0 ? sum / weight : 0;
}

Vector<3> Bed::random_direction(Random& random) const {
  if (dimension() == 3) return uniform_direction<3>(random);
  const Vector<2> u = uniform_direction<2>(random);
  return {u[0], u[1], 0};
}

bool Bed::fits_between_spheres(const Vector<3>& c, double r) const {
  return !grid_.any_near(c, r + skin_, [&](Id j) {
    const double s = r + balls_[j].r + skin_;
    return way(c, balls_[j].center).squaredNorm() < s * s;
  });
}

bool Bed::fits(const Vector<3>& c, double r) const {
  if (!fits_between_spheres(c, r)) return false;
  std::optional<EffectTimer> exact_timer;
  if (Effect* exact = exact_walls()) exact_timer.emplace(*exact);
  return container_.contains(c, r + skin_);
}

Surroundings Bed::surroundings(double give) const {
  return [this, give, walls = walls_of(container_)](const Vector<3>& place, double reach,
                                                    std::vector<Obstacle>& obstacles) {
    walls(place, std::max(0.0, reach - give), obstacles);
    for (Obstacle& wall : obstacles) wall.distance += give;
    grid_.for_each_near(place, reach + skin_, [&](Id j) {
      const Vector<3> away = -way(place, balls_[j].center);
      const double center_distance = away.norm(), distance = center_distance - balls_[j].r - skin_;
      if (distance < reach && center_distance > 0) obstacles.push_back({away / center_distance, distance});
    });
  };
}

double Bed::room_between_spheres(const Vector<3>& c, double enough, double limit) const {
  return bernal::room_between_spheres(grid_, c, enough, limit, skin_, [&](Id j) {
    return Nearby{way(c, balls_[j].center).squaredNorm(), balls_[j].r};
  });
}

void Bed::insert(const Vector<3>& place, double r, std::uint32_t tag) {
  const Vector<3> c = container_.boundary().wrap(place);
  grid_.insert(static_cast<Id>(balls_.size()), c, r);
  balls_.push_back({c, r});
  tags_.push_back(tag);
  far_from_wall_.push_back(0);
  far_from_wall_at_.push_back(c);
  sum_of_radii_ += r;
  sum_of_volumes_ += ball_volume(dimension(), r);
}

bool Bed::insert_if_all_fit(const Spheres<3>& spheres) {
  if (exact_walls()) return false;
  std::atomic<bool> all_fit = true;
  const auto ask_all = [&](const auto& fits) {
    parallel_ranges(spheres.size(), block_size, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last && all_fit; ++i)
        if (!fits(i)) all_fit = false;
    });
    return all_fit.load();
  };
  if (!ask_all([&](std::size_t i) { return container_.contains(spheres.center(i), spheres.r[i] + skin_); }))
    return false;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    insert(spheres.center(i), spheres.r[i], static_cast<std::uint32_t>(i));
  const auto fits_between = [&](std::size_t i) {
    const Vector<3> c = spheres.center(i);
    return !grid_.any_near(c, spheres.r[i] + skin_, [&](Id j) {
      const double s = spheres.r[i] + balls_[j].r + skin_;
      return j < i && way(c, balls_[j].center).squaredNorm() < s * s;
    });
  };
  if (ask_all(fits_between)) return true;
  remove_tags_from(0);
  return false;
}

void Bed::remove_tags_from(std::uint32_t first) {
  std::vector<Id> kept;
  for (Id i = 0; i < balls_.size(); ++i) {
    if (tags_[i] < first) kept.push_back(i);
  }
  reorder(kept);
}

void Bed::sort_by_height(const Vector<3>& direction) {
  if (balls_.empty()) return;
  // Two axes across the direction; within a layer, rows, so that neighbours lie close in memory.
  const Vector<3> across = direction.unitOrthogonal();
  const Vector<3> along_row = direction.cross(across);
  const double layer = 2 * mean_radius();
  struct Key {
    double height, row, place;
    Id id;
  };
  std::vector<Key> keys;
  keys.reserve(balls_.size());
  for (Id i = 0; i < balls_.size(); ++i) {
    const Vector<3>& c = balls_[i].center;
    keys.push_back(
        {std::floor(-direction.dot(c) / layer), std::floor(across.dot(c) / layer), along_row.dot(c), i});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.height, a.row, a.place, a.id) < std::tie(b.height, b.row, b.place, b.id);
  });
  std::vector<Id> order;
  order.reserve(keys.size());
  for (const Key& k : keys) order.push_back(k.id);
  reorder(order);
}

void Bed::reorder(const std::vector<Id>& order) {
  permute(balls_, order);
  permute(tags_, order);
  permute(far_from_wall_, order);
  permute(far_from_wall_at_, order);
  grid_.clear();
  sum_of_radii_ = sum_of_volumes_ = 0;
  for (Id i = 0; i < balls_.size(); ++i) {
    const double r = balls_[i].r;
    grid_.insert(i, balls_[i].center, r);
    sum_of_radii_ += r;
    sum_of_volumes_ += ball_volume(dimension(), r);
  }
}

void Bed::update_grid() {
  for (Id i = 0; i < balls_.size(); ++i) grid_.move(i, balls_[i].center);
}

/// Where a sphere was far from the wall its images are.
void Bed::wrap() {
  for (Id i = 0; i < balls_.size(); ++i) {
    const Vector<3> wrapped = container_.boundary().wrap(balls_[i].center);
    far_from_wall_at_[i] += wrapped - balls_[i].center;
    balls_[i].center = wrapped;
  }
}

double Bed::enclose(double buffer) {
  const EffectTimer timer(effects_["neighbour lists"]);
  if (repeats_) wrap();
  update_grid();
  buffer = buffer_ = std::min(buffer, longest_buffer_);
  const std::size_t n = balls_.size();
  const std::size_t blocks = (n + block_size - 1) / block_size;
  std::vector<std::vector<Id>> near_spheres(blocks);
  std::vector<std::vector<NearFacet>> near_facets(blocks);
  box_centers_.resize(n);
  first_neighbor_.assign(n + 1, 0);
  first_facet_.assign(n + 1, 0);
  meets_images_.assign(n, 0);

  parallel_for(blocks, [&](std::size_t block) {
    std::vector<NearFacet> facets;
    const auto end = static_cast<Id>(std::min(n, (block + 1) * block_size));
    for (auto i = static_cast<Id>(block * block_size); i < end; ++i) {
      const Ball& ball = balls_[i];
      box_centers_[i] = ball.center;

      const double boxes = ball.r + 2 * buffer + 2 * skin_;
      const std::size_t before = near_spheres[block].size();
      grid_.for_each_near(ball.center, boxes, [&](Id j) {
        const Ball& other = balls_[j];
        const Vector<3> apart = way(ball.center, other.center);
        if (j == i || apart.cwiseAbs().maxCoeff() > boxes + other.r) return;
        near_spheres[block].push_back(j);
        if (repeats_ && apart != other.center - ball.center) meets_images_[i] = 1;
      });
      first_neighbor_[i + 1] = near_spheres[block].size() - before;

      // The clearance is 1-Lipschitz: a wall that was far when last asked is still far after a small move.
      const double reach = ball.r + std::numbers::sqrt3 * buffer + 2 * skin_;
      if (far_from_wall_[i] - (ball.center - far_from_wall_at_[i]).norm() > reach) continue;
      const double wide_reach = reach + 2 * buffer;
      facets.clear();
      container_.facets_near(ball.center, wide_reach, facets);
      far_from_wall_[i] = facets.empty() ? wide_reach : facets.front().distance;
      far_from_wall_at_[i] = ball.center;
      for (const NearFacet& f : facets) {
        if (f.distance > reach) break;
        near_facets[block].push_back(f);
        ++first_facet_[i + 1];
      }
    }
  });
  put_end_to_end(near_spheres, first_neighbor_, neighbors_);
  put_end_to_end(near_facets, first_facet_, facets_);
  return buffer;
}

std::vector<std::uint32_t> Bed::tags() const {
  std::vector<std::uint32_t> ascending = tags_;
  std::ranges::sort(ascending);
  return ascending;
}

Spheres<3> Bed::spheres() const {
  std::vector<Id> order(balls_.size());
  std::iota(order.begin(), order.end(), Id{0});
  std::sort(order.begin(), order.end(), [&](Id a, Id b) { return tags_[a] < tags_[b]; });
  Spheres<3> result;
  result.reserve(order.size());
  for (const Id i : order) result.push_back(container_.boundary().wrap(balls_[i].center), balls_[i].r);
  return result;
}

Spheres<dynamic> Bed::spheres_as_packed() const {
  Spheres<dynamic> all(spheres());
  all.x.resize(static_cast<std::size_t>(dimension()));
  return all;
}

}  // namespace bernal
