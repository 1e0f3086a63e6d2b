#include "stages/relax_reference.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "bernal/domain/boundary.hpp"
#include "stages/free_of_overlap.hpp"

namespace bernal {
namespace {

template <int D>
class Loop {
 public:
  Loop(Spheres<D> spheres, const Vector<D>& edges, Random random)
      : spheres_(std::move(spheres)), boundary_{edges} {
    const Bounds<D> bounds{Vector<D>::Zero(), edges};
    for (std::size_t i = 0; i < spheres_.size(); ++i) spheres_.set_center(i, uniform_point(random, bounds));
  }

  /// One cycle: every sphere once. Returns the largest overlap ratio that was met.
  double sweep() {
    double largest = 0;
    for (std::size_t i = 0; i < spheres_.size(); ++i) largest = std::max(largest, push(i));
    return largest;
  }

  void grow(double factor) {
    boundary_.edges *= factor;
    for (auto& column : spheres_.x)
      for (double& x : column) x *= factor;
  }

  const Spheres<D>& spheres() const { return spheres_; }
  const Vector<D>& edges() const { return boundary_.edges; }

 private:
  double push(std::size_t i) {
    const Vector<D> c = spheres_.center(i);
    Vector<D> sum = Vector<D>::Zero();
    int overlapping = 0;
    double largest = 0;
    for (std::size_t j = 0; j < spheres_.size(); ++j) {
      if (j == i) continue;
      const Vector<D> away = boundary_.minimum_image(c - spheres_.center(j));
      const double reach = spheres_.r[i] + spheres_.r[j], d = away.norm();
      if (!(d < reach)) continue;
      if (d > 0) sum += away * (reach / d - 1);
      ++overlapping;
      largest = std::max(largest, 1 - d / reach);
    }
    if (overlapping > 0) spheres_.set_center(i, boundary_.wrap(c + sum / overlapping));
    return largest;
  }

  Spheres<D> spheres_;
  Boundary<D> boundary_;
};

}  // namespace

template <int D>
StageEnd relax_by_the_book(PeriodicWork& work, const RelaxOptions& options) {
  Loop<D> loop(work.spheres.in<D>(), work.edges, work.random(Stream::relax));
  const double decades = std::log10(static_cast<double>(work.spheres.size()));
  const int cycles = std::max(1, static_cast<int>(std::lround(options.alpha * decades * decades)));
  StageEnd end = StageEnd::converged;
  for (;;) {
    double molr = 0;
    for (int cycle = 0; cycle < cycles; ++cycle) molr = loop.sweep();
    if (molr < options.stop) break;
    loop.grow(1 + molr / options.beta);
    work.edges = loop.edges();
    work.milestone("relax", std::min(0.99, std::log(molr) / std::log(options.stop)), molr);
    if (work.monitor.stop()) {
      end = StageEnd::cancelled;
      break;
    }
  }
  loop.grow(factor_free_of_overlap(loop.spheres(), loop.edges()));
  work.edges = loop.edges();
  work.spheres = loop.spheres();
  work.placed = true;
  return end;
}

#define BERNAL_INSTANTIATE(D) template StageEnd relax_by_the_book<D>(PeriodicWork&, const RelaxOptions&);
BERNAL_INSTANTIATE(1)
BERNAL_INSTANTIATE(2)
BERNAL_INSTANTIATE(3)
BERNAL_INSTANTIATE(4)
BERNAL_INSTANTIATE(5)
BERNAL_INSTANTIATE(6)
BERNAL_INSTANTIATE(7)
BERNAL_INSTANTIATE(8)

}  // namespace bernal
