#include "soft/relax.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/domain/boundary.hpp"
#include "core/every_dimension.hpp"
#include "neighbors/cell_grid.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {
namespace {

template <int D>
class Loop {
 public:
  Loop(Spheres<D>& spheres, Vector<D>& edges, bool settle, Random random)
      : spheres_(spheres),
        edges_(edges),
        settle_(settle),
        random_(random),
        boundary_{edges},
        r_max_(std::ranges::max(spheres.r)),
        grid_(boundary_, std::ranges::min(spheres.r), r_max_, spheres.size()) {
    for (std::size_t i = 0; i < spheres.size(); ++i)
      grid_.insert(static_cast<Id>(i), spheres.center(i), spheres.r[i]);
  }

  /// Every sphere once. Returns the largest overlap ratio that was met.
  double sweep() {
    double largest = 0;
    for (Id i = 0; i < spheres_.size(); ++i) {
      const double overlap = push(i);
      largest = std::max(largest, overlap);
      if (settle_ && overlap == 0) settle(i);
    }
    return largest;
  }

  void grow(double factor) {
    resize_box<D>(spheres_, edges_, edges_ * factor);
    boundary_.edges = edges_;
    grid_.rescale(edges_);
  }

 private:
  using Id = typename CellGrid<D>::Id;

  /// Moves sphere i to the mean of the places where it would touch one of those that it overlaps. Returns the
  /// largest of its overlap ratios, before.
  double push(Id i) {
    const Vector<D> c = spheres_.center(i);
    Vector<D> sum = Vector<D>::Zero();
    int overlapping = 0;
    double largest = 0;
    grid_.for_each_near(c, spheres_.r[i], [&](Id j) {
      if (j == i) return;  // its own images are at least its diameter away
      const double reach = spheres_.r[i] + spheres_.r[j];
      for_each_image(c - spheres_.center(j), reach, [&](const Vector<D>& away) {
        const double squared = away.squaredNorm();
        if (!(squared < reach * reach)) return;
        const double d = std::sqrt(squared);
        sum += d > 0 ? Vector<D>(away * (reach / d - 1)) : Vector<D>(reach * uniform_direction<D>(random_));
        ++overlapping;
        largest = std::max(largest, 1 - d / reach);
      });
    });
    if (overlapping > 0) move(i, c + sum / overlapping);
    return largest;
  }

  /// Moves sphere i, which overlaps nothing, towards the one across the smallest gap until they touch. As all
  /// other gaps are wider, it overlaps nothing then either.
  void settle(Id i) {
    const Vector<D> c = spheres_.center(i);
    const double farthest = edges_.norm();
    double gap = std::numeric_limits<double>::infinity();
    Vector<D> towards = Vector<D>::Zero();
    for (double within = r_max_; !(gap <= within) && within < 2 * farthest; within *= 2) {
      grid_.for_each_near(c, spheres_.r[i] + within, [&](Id j) {
        if (j == i) return;
        const Vector<D> way = boundary_.minimum_image(spheres_.center(j) - c);
        const double d = way.norm();
        if (!(d - spheres_.r[i] - spheres_.r[j] < gap)) return;
        gap = d - spheres_.r[i] - spheres_.r[j];
        towards = way / d;
      });
    }
    if (std::isfinite(gap)) move(i, c + gap * towards);
  }

  void move(Id i, const Vector<D>& c) {
    const Vector<D> wrapped = boundary_.wrap(c);
    spheres_.set_center(i, wrapped);
    grid_.move(i, wrapped);
  }

  /// Of a displacement, the images that may be shorter than `reach`: the shortest alone where the box is
  /// wide.
  template <class Visit>
  void for_each_image(const Vector<D>& displacement, double reach, Visit&& visit) const {
    if (2 * reach <= edges_.minCoeff()) {
      visit(boundary_.minimum_image(displacement));
    } else {
      boundary_.for_each_image(displacement, reach, visit);
    }
  }

  Spheres<D>& spheres_;
  Vector<D>& edges_;
  bool settle_;
  Random random_;
  Boundary<D> boundary_;
  double r_max_;
  CellGrid<D> grid_;
};

}  // namespace

template <int D>
StageEnd relax_by_the_book(Spheres<D>& spheres, Vector<D>& edges, Work& work, const Relax& options) {
  Loop<D> loop(spheres, edges, options.settle, work.random(Stream::relax));
  const int sweeps = sweeps_a_cycle(options, spheres.size());
  double reported = 0;
  for (;;) {
    double molr = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      if (work.monitor.stop()) return StageEnd::cancelled;
      molr = loop.sweep();
    }
    if (molr < options.stop) return StageEnd::converged;
    loop.grow(1 + molr / options.beta);
    const double done = std::log(molr) / std::log(options.stop);
    if (done < reported) continue;
    reported = done + 0.005;
    work.edges = edges;
    work.milestone("relax", std::clamp(done, 0.0, 0.99), molr);
  }
}

#define BERNAL_INSTANTIATE(D) \
  template StageEnd relax_by_the_book<D>(Spheres<D>&, Vector<D>&, Work&, const Relax&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
