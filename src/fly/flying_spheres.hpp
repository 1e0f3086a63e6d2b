#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/archive.hpp"
#include "core/event_clock.hpp"
#include "core/made.hpp"
#include "near/partial_grid.hpp"
#include "work/spheres_in_box.hpp"

namespace bernal {

/// Spheres that fly through a box and the queue of those that have no place in it yet, sorted from large to
/// small: what the patent's procedure and the event-driven one share. Whole arrays, one column an axis.
///
/// Spheres keep a distance of (1 + margin)(ri + rj), so that rounding, which is far smaller than the margin,
/// leaves none overlapping at its own radius. Between two walls a sphere keeps (1 + margin) r from each.
///
/// Pairs whose surfaces are nearer than `skin` are listed; the list holds until a sphere has flown half of
/// that. A pair stands once, however many of its images meet.
template <int D>
class FlyingSpheres {
 public:
  using Id = std::uint32_t;
  using Columns = Eigen::Array<double, Eigen::Dynamic, D>;
  struct Pair {
    using ArchivedAsBytes = void;
    Id first, second;
  };

  /// Precondition: every sphere has room in the box for itself. `axes` as PartialGrid's.
  explicit FlyingSpheres(const SpheresInBox& in_box, int axes = PartialGrid::automatic);

  std::size_t size() const { return tags_.size(); }
  std::size_t wanted() const { return drawn_.size(); }
  /// Sizes that wait, from large to small.
  const std::vector<Id>& queue() const { return queue_; }
  double waiting_radius(std::size_t place) const { return drawn_[queue_[place]]; }
  double volume() const { return volume_; }

  double radius(Id i) const { return r_[i]; }
  double mass(Id i) const { return mass_[i]; }
  double mean_radius() const { return mean_radius_; }
  double smallest_radius() const { return smallest_; }
  double skin() const { return skin_; }
  double margin() const { return margin_; }
  double edge(int k) const { return edges_[k]; }
  bool repeats(int k) const { return repeats_[k]; }
  /// Where the centre of sphere i can be between two walls.
  double low(double r) const { return (1 + margin_) * r; }
  double high(int k, double r) const { return edges_[k] - (1 + margin_) * r; }
  double contact(Id i, Id j) const { return (1 + margin_) * (r_[i] + r_[j]); }

  auto places() { return x.topRows(static_cast<Eigen::Index>(size())); }
  auto velocities() { return v.topRows(static_cast<Eigen::Index>(size())); }
  Vector<D> center(Id i) const { return row(x, i); }
  Vector<D> velocity(Id i) const { return row(v, i); }
  void set_velocity(Id i, const Vector<D>& w) { set_row(v, i, w); }
  static Vector<D> row(const Columns& columns, Id i) {
    Vector<D> w;
    for (int k = 0; k < D; ++k) w[k] = columns(i, k);
    return w;
  }
  /// |x_i - y_i|² and |x_i|², the sum of two halves, of which each is the sum of two halves.
  template <int First = 0, int Count = D>
  static double squared_distance(const Columns& x, const Columns& y, Id i) {
    if constexpr (Count == 1) {
      const double d = x(i, First) - y(i, First);
      return d * d;
    } else {
      return squared_distance<First, Count / 2>(x, y, i) +
             squared_distance<First + Count / 2, Count - Count / 2>(x, y, i);
    }
  }
  template <int First = 0, int Count = D>
  static double squared_norm(const Columns& x, Id i) {
    if constexpr (Count == 1)
      return x(i, First) * x(i, First);
    else
      return squared_norm<First, Count / 2>(x, i) + squared_norm<First + Count / 2, Count - Count / 2>(x, i);
  }
  static void set_row(Columns& columns, Id i, const Vector<D>& w) {
    for (int k = 0; k < D; ++k) columns(i, k) = w[k];
  }
  /// Of a displacement within the box, the nearest image.
  Vector<D> nearest(Vector<D> d) const {
    for (int k = 0; k < D; ++k)
      if (repeats_[k] && std::abs(d[k]) > 0.5 * edges_[k]) d[k] -= std::copysign(edges_[k], d[k]);
    return d;
  }
  /// Whether a pair can meet in more than one place at a time.
  bool is_small() const;
  /// Two that touch rebound elastically, in proportion to their volumes.
  void collide(Id i, Id j) { collide(i, j, nearest(center(i) - center(j))); }
  /// The same for an image, `d` being the way from j to i.
  void collide(Id i, Id j, const Vector<D>& d) {
    const double approach = d.dot(velocity(i) - velocity(j));
    const Vector<D> impulse = d * (2 * approach / (d.squaredNorm() * (mass_[i] + mass_[j])));
    set_velocity(i, velocity(i) - mass_[j] * impulse);
    set_velocity(j, velocity(j) + mass_[i] * impulse);
  }
  double kinetic_energy() const {
    double sum = 0;
    for (Id i = 0; i < size(); ++i) sum += 0.5 * mass_[i] * squared_norm(v, i);
    return sum;
  }

  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Takes centres that have left the box to their images in it.
  void wrap_all();
  /// Lists the near pairs of all. Centres are at most half an edge outside the box.
  void sort();
  /// Tells the grid where all are now; to be called before places are looked for.
  void update() {
    if (is_worn()) sort();
    grid_->update(columns_of(x));
  }
  /// Whether so many are new that all should be sorted again.
  bool is_worn() const { return grid_->unsorted() > 64 + size() / 16; }

  Vector<D> random_place(double r, Random& random) const {
    Vector<D> c;
    for (int k = 0; k < D; ++k)
      c[k] = repeats_[k] ? random.uniform(0, edges_[k]) : random.uniform(low(r), high(k, r));
    return c;
  }
  /// Whether a sphere has room there.
  bool is_free(const Vector<D>& c, double r) const;
  /// Moves the centre away from what it overlaps, a few times. Returns whether it has room then.
  bool push_into_room(Vector<D>& c, double r, int pushes) const;
  /// Tries `batch` random places, in turn for the largest that wait: those within a tenth of the very
  /// largest, so that no smaller one takes their room. find_room(c, r) says whether a sphere has room at c,
  /// which it may move; placed(c) is called when it has been put there.
  template <class FindRoom, class Placed>
  std::size_t insert(std::size_t batch, Random& random, FindRoom&& find_room, Placed&& placed) {
    const std::size_t before = size();
    std::size_t place = 0, eligible = 0;
    for (; batch > 0 && !queue_.empty(); --batch) {
      if (eligible == 0) {
        const double least = 0.9 * drawn_[queue_.front()];
        eligible = static_cast<std::size_t>(
            std::ranges::partition_point(queue_, [&](Id tag) { return drawn_[tag] >= least; }) -
            queue_.begin());
      }
      if (place >= eligible) place = 0;
      const double r = drawn_[queue_[place]];
      Vector<D> c = random_place(r, random);
      if (find_room(c, r)) {
        accept(place, c, random);
        placed(c);
        --eligible;
        in_vain_ = 0;
      } else {
        ++place;
        ++in_vain_;
      }
    }
    return size() - before;
  }
  /// Places tried since the last that was free.
  double in_vain() const { return in_vain_; }
  /// Puts the sphere at `place` of the queue where it has room, flying.
  void accept(std::size_t place, const Vector<D>& c, Random& random);
  /// In a random direction with the kinetic energy of all.
  Vector<D> thermal(Id i, Random& random) const { return uniform_direction<D>(random) / std::sqrt(mass_[i]); }
  /// Share of the volume that is to be placed which has been.
  double share() const { return volume_ / whole_volume_; }

  /// Gives those that are placed their centres, in [0, edges). Returns their numbers, ascending.
  std::vector<Id> write_to(Spheres<dynamic>& drawn) const;

  /// All of their state, of the same spheres in the same box.
  void archive(Archive& a) { a(x, v, queue_, tags_, r_, mass_, volume_, in_vain_, *grid_, pairs_); }

  Columns x, v;

 private:
  const Made made_{"flight"};
  void wrap(double& c, int k) const {
    if (!repeats_[k] || (c >= 0 && c < edges_[k])) return;
    c -= edges_[k] * std::floor(c / edges_[k]);
    if (!(c < edges_[k])) c = 0;
  }

  Vector<D> edges_;
  PartialGrid::EachAxis<bool> repeats_{};
  std::vector<double> drawn_;
  double margin_;
  std::vector<Id> queue_;
  double mean_radius_, smallest_, largest_, skin_;
  int axes_;
  std::vector<Id> tags_;  // which of the drawn ones each is
  std::vector<double> r_, mass_;
  double volume_ = 0, whole_volume_ = 0;  // in balls of the mean radius
  double in_vain_ = 0;
  std::optional<PartialGrid> grid_;
  std::vector<Pair> pairs_;
};

}  // namespace bernal
