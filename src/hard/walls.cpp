#include "hard/walls.hpp"

#include <numeric>

#include "hard/place_on_curve.hpp"

namespace bernal {
namespace {

/// With no more walls than these all are looked at for each sphere.
constexpr std::size_t few_walls = 16;
/// The grid of others is divided in two along each edge so many times.
constexpr int divisions = 4;
/// What cells are prepared for beyond the reach at hand, so that they last while shells grow.
constexpr double spare_reach = 1.25;
/// Of half a cell's diagonal: what rounding cannot be as large as.
constexpr double slack = 1.001;

}  // namespace

template <int D>
void Walls<D>::start(std::size_t count, double most) {
  if (!made_) made_.emplace("reflections");
  next_.assign(count, 0);
  if (facets_) return views_.resize(count);
  near_.start(count, 0);
  lists_.resize(count);
  for (NeighborPool::List& list : lists_) list = near_.make();
  if (most <= reach_) return;
  reach_ = spare_reach * most;
  levels_ = walls_.size() > few_walls ? divisions : 0;
  cells_.assign(std::size_t{1} << (levels_ * D), {});
  std::vector<Id> all(walls_.size());
  std::iota(all.begin(), all.end(), Id{0});
  if (levels_ == 0)
    cells_[0] = std::move(all);
  else
    fill_cells(Vector<D>::Zero(), edges_, levels_, 0, all);
}

/// The cells of the part of the box that is divided `level` times more, which are numbered from `first` on,
/// along the curve of `place_on_curve`.
template <int D>
void Walls<D>::fill_cells(const Vector<D>& lower, const Vector<D>& size, int level, std::size_t first,
                          const std::vector<Id>& near) {
  const Vector<D> middle = lower + 0.5 * size;
  const double half_diagonal = slack * 0.5 * size.norm();
  std::vector<Id> nearer;
  for (const Id w : near) {
    const double clearance = walls_[w].clearance(middle);
    if (clearance < -half_diagonal) return;  // all of it is outside
    if (clearance < half_diagonal + reach_) nearer.push_back(w);
  }
  if (level == 0) {
    cells_[first] = std::move(nearer);
    return;
  }
  const std::size_t cells_a_part = std::size_t{1} << ((level - 1) * D);
  for (std::size_t part = 0; part < (std::size_t{1} << D); ++part) {
    Vector<D> corner = lower;
    for (int k = 0; k < D; ++k)
      if (part >> k & 1) corner[k] = middle[k];
    fill_cells(corner, 0.5 * size, level - 1, first + part * cells_a_part, nearer);
  }
}

template <int D>
void Walls<D>::settle(Id i, const Vector<D>& home, double reach) {
  if (facets_) {
    views_[i].home = home;
    return facets_->find_near(point_in_space<D>(home), reach, views_[i].near);
  }
  found_.clear();
  for (const Id w : cells_[place_on_curve<D>(home, edges_) >> (63 / D - levels_) * D])
    if (walls_[w].clearance(home) < reach) found_.push_back(w);
  near_.replace(lists_[i], found_);
}

template <int D>
double Walls<D>::time_to_touch(Id i, const Vector<D>& p, const Vector<D>& v, double radius, double growth,
                               double limit) {
  if (facets_) return time_to_touch_facet(i, p, v, radius, growth, limit);
  double first = std::numeric_limits<double>::infinity();
  for (const Id w : near_.of(lists_[i])) {
    const double time = walls_[w].time_to_touch(p, v, radius, growth);
    if (time < first) {
      first = time;
      next_[i] = w;
    }
  }
  return first;
}

template <int D>
double Walls<D>::time_to_touch_facet(Id i, const Vector<D>& p, const Vector<D>& v, double radius,
                                     double growth, double limit) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const View& view = views_[i];
  if (view.near.empty()) return never;
  const Vector<3> at = point_in_space<D>(p), velocity = point_in_space<D>(v);
  const Vector<3> way = point_in_space<D>(p - view.home);
  const double moved = way.norm(), fastest = velocity.norm() + growth;
  double first = limit;
  for (const auto& [normal, clearance, facet] : view.near) {
    if (clearance - moved - radius >= fastest * first) break;  // nor do those after it come before
    // A convex facet lies behind the plane through its point nearest to the home.
    const double gap = clearance + normal.dot(way) - radius;
    if (gap > 0 && gap >= (growth - normal.dot(velocity)) * first) continue;
    const double time = facets_->time_to_touch(facet, at, velocity, radius, growth, first);
    if (!(time < first)) continue;
    first = time;
    next_[i] = facet;
  }
  return first < limit ? first : never;
}

template <int D>
Vector<D> Walls<D>::outward(Id i, const Vector<D>& p) const {
  if constexpr (D == 2 || D == 3)
    if (facets_) return facets_->outward(next_[i], point_in_space<D>(p)).template head<D>();
  return walls_[next_[i]].outward(p);
}

template <int D>
double Walls<D>::reflect(Id i, const Vector<D>& p, Vector<D>& v, double growth, double least) const {
  const Vector<D> n = outward(i, p);
  const double kick = std::max(least, 2 * (n.dot(v) + growth));
  v -= kick * n;
  return kick;
}

#define BERNAL_INSTANTIATE(D) template class Walls<D>;
BERNAL_IN_FLYING_DIMENSIONS(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
