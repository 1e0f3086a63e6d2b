#include "fly/fill_by_classes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/event_clock.hpp"
#include "core/made.hpp"
#include "core/order.hpp"
#include "near/cell_grid.hpp"
#include "work/free_of_overlap.hpp"
#include "work/holes.hpp"

namespace bernal {
namespace {

/// Spheres down to this share of the largest of a class belong to it: a level of the background grid.
constexpr double least_of_class = 0.5;
/// Random places that are tried for a sphere before the others of its class are moved.
constexpr int tries = 4;
/// So often a place that overlaps is pushed to where it does not.
constexpr int most_pushes = 12;
/// A push goes this much farther than contact, and over-relaxed where there are several.
constexpr double beyond_contact = 1e-4, over_relaxation = 1.5;
/// A class is left when moving it has helped fewer than this share of those that wait, so often in a row.
constexpr double worthwhile = 0.02;
constexpr int patience = 8;
/// Sweeps of random moves between two rounds of trials, and how the moves adapt, to what share of success.
constexpr int sweeps_a_round = 1;
constexpr double first_step = 0.3, successful = 0.4, adapted = 1.1, shortest_step = 1e-3;

template <int D>
class Insertion {
 public:
  Insertion(SpheresInBox& in_box, Reporter& report)
      : in_box_(in_box),
        report_(report),
        random_(report.random(Stream::insert)),
        spheres_(in_box.spheres.in<D>()),
        edges_(*in_box.task.target_edges),
        boundary_{edges_},
        smallest_(std::ranges::min(spheres_.r)),
        reach_share_((1 - in_box.task.allowed_overlap) *
                     (1 + tolerance::growth(edges_.maxCoeff() / smallest_))),
        grid_(boundary_, smallest_, std::ranges::max(spheres_.r), spheres_.size()),
        placed_(spheres_.size(), false),
        order_(largest_first(spheres_.r)) {}

  /// `full` where not all found a place: then the others are put into holes, where they overlap. Where it is
  /// cancelled only those that found one are left.
  StageEnd run() {
    std::size_t first = 0;
    const Resumable part(report_, "classes",
                         [&](Archive& a) { a(first, random_, spheres_, grid_, placed_, count_, trials_); });
    for (Id i = 0; i < spheres_.size(); ++i) balls_.push_back({spheres_.center(i), spheres_.r[i]});
    if (!part.resumed() && in_box_.placed) keep_places();
    while (first < order_.size()) {
      const double least = least_of_class * spheres_.r[order_[first]];
      std::size_t last = first;
      while (last < order_.size() && spheres_.r[order_[last]] > least) ++last;
      insert_class({order_.begin() + static_cast<std::ptrdiff_t>(first),
                    order_.begin() + static_cast<std::ptrdiff_t>(last)});
      first = last;
      cancelled_ = cancelled_ || report_.monitor.stop();
      if (cancelled_) break;
    }
    std::vector<Id> waiting;
    std::ranges::copy_if(order_, std::back_inserter(waiting), [&](Id i) { return !placed_[i]; });
    const bool all = waiting.empty();
    if (!all && !cancelled_) move_to_holes<D>(spheres_, edges_, std::move(waiting), random_);
    if (trials_.events() > 0) report_.effects["trial places"] += {"", trials_.events(), trials_.seconds()};
    in_box_.spheres = std::move(spheres_);
    if (cancelled_) in_box_.leave(with_places());
    in_box_.edges = edges_;
    in_box_.needed_volume = edges_.prod();
    in_box_.placed = true;
    return cancelled_ ? StageEnd::cancelled : all ? StageEnd::converged : StageEnd::full;
  }

 private:
  using Id = typename CellGrid<D>::Id;
  /// A sphere in one place of memory, as searches look at them in any order.
  struct Ball {
    Vector<D> center;
    double r;
  };

  std::vector<Id> with_places() const {
    std::vector<Id> numbers;
    for (Id i = 0; i < placed_.size(); ++i)
      if (placed_[i]) numbers.push_back(i);
    return numbers;
  }

  void keep_places() {
    Vector<D> edges = in_box_.edges;
    resize_box<D>(spheres_, edges, edges_);
    for (const Id i : order_)
      if (const Vector<D> c = spheres_.center(i); push_at(c, i).overlaps == 0) place(i, c);
  }

  void insert_class(const std::vector<Id>& members) {
    double step = first_step;
    int failures = 0;
    std::size_t waiting = 0, found = 0;
    const Resumable part(report_, "class", [&](Archive& a) { a(step, failures, waiting, found); });
    for (bool goes_on = part.resumed(); failures < patience;) {
      if (!std::exchange(goes_on, false)) {
        waiting = found = 0;
        for (const Id i : members) {
          if (placed_[i]) continue;
          ++waiting;
          if (find_place(i)) ++found;
        }
      }
      if (found == waiting || (cancelled_ = report_.stop())) return;
      failures = static_cast<double>(found) < worthwhile * static_cast<double>(waiting) ? failures + 1 : 0;
      for (int k = 0; k < sweeps_a_round; ++k) move_at_random(members, step);
      const double done = static_cast<double>(count_) / static_cast<double>(placed_.size());
      report_.milestone("fill", in_box_, 0, done);
    }
  }

  bool find_place(Id i) {
    const Bounds<D> box{Vector<D>::Zero(), edges_};
    for (int t = 0; t < tries; ++t) {
      Vector<D> c = uniform_point(random_, box);
      for (int k = 0; k <= most_pushes; ++k) {
        const EventClock::Event trial(trials_);
        const Push push = push_at(c, i);
        if (push.overlaps == 0) {
          place(i, c);
          return true;
        }
        c = boundary_.wrap(c + push.by);
      }
    }
    return false;
  }

  struct Push {
    Vector<D> by = Vector<D>::Zero();
    int overlaps = 0;
  };
  /// What takes sphere i from c to where it does not overlap those that it does there.
  Push push_at(const Vector<D>& c, Id i) const {
    Push push;
    const double r = spheres_.r[i];
    grid_.for_each_near(c, r * (1 + beyond_contact), [&](Id j) {
      if (j == i) return;
      const Ball& other = balls_[j];
      const Vector<D> away = boundary_.minimum_image(c - other.center);
      const double reach = reach_share_ * (r + other.r), squared = away.squaredNorm();
      if (!(squared < reach * reach)) return;
      ++push.overlaps;
      if (squared > 0) push.by += away * (reach / std::sqrt(squared) * (1 + beyond_contact) - 1);
    });
    if (push.overlaps > 1) push.by *= std::min(1.0, over_relaxation / push.overlaps);
    return push;
  }

  void set_center(Id i, const Vector<D>& c) {
    spheres_.set_center(i, c);
    balls_[i].center = c;
  }

  void place(Id i, const Vector<D>& c) {
    set_center(i, c);
    grid_.insert(i, c, spheres_.r[i]);
    placed_[i] = true;
    ++count_;
  }

  /// Moves those of a class that have places, by up to `step` radii on each axis, where nothing is in the
  /// way.
  void move_at_random(const std::vector<Id>& members, double& step) {
    std::size_t moved = 0, there = 0;
    for (const Id i : members) {
      if (!placed_[i]) continue;
      ++there;
      Vector<D> c = spheres_.center(i);
      for (int k = 0; k < D; ++k) c[k] += random_.uniform(-1.0, 1.0) * step * spheres_.r[i];
      c = boundary_.wrap(c);
      if (blocked(c, i)) continue;
      ++moved;
      set_center(i, c);
      grid_.move(i, c);
    }
    const bool often = static_cast<double>(moved) > successful * static_cast<double>(there);
    step = std::clamp(often ? step * adapted : step / adapted, shortest_step, 1.0);
  }

  bool blocked(const Vector<D>& c, Id i) const {
    const double r = spheres_.r[i];
    return grid_.any_near(c, r * (1 + beyond_contact), [&](Id j) {
      const Ball& other = balls_[j];
      const double reach = reach_share_ * (r + other.r);
      return j != i && boundary_.minimum_image(c - other.center).squaredNorm() < reach * reach;
    });
  }

  SpheresInBox& in_box_;

  Reporter& report_;
  Random random_;
  Spheres<D> spheres_;
  const Vector<D> edges_;
  const Boundary<D> boundary_;
  const double smallest_, reach_share_;
  std::vector<Ball> balls_;  // of all
  CellGrid<D> grid_;
  std::vector<bool> placed_;
  bool cancelled_ = false;
  std::size_t count_ = 0;  // of those
  std::vector<Id> order_;
  EventClock trials_;
  const Made made_{"trial places"};
};

}  // namespace

StageEnd fill_by_classes(SpheresInBox& in_box, Reporter& report, const FillOptions& options) {
  bool inserted = false;
  const Resumable part(report, "fill by classes", [&](Archive& a) {
    a(inserted);
    if (inserted) a(in_box.placed, in_box.edges, in_box.needed_volume);
  });
  if (!inserted && !in_box.spheres.empty() && fits_box(in_box)) {
    const EffectTimer timer(report.effects["insertion"]);
    const StageEnd end = with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
      return Insertion<decltype(dimension)::value>(in_box, report).run();
    });
    if (end != StageEnd::full) return end;
  }
  inserted = true;
  return fill_by_relaxation(in_box, report, options);
}

}  // namespace bernal
