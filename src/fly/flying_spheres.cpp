#include "fly/flying_spheres.hpp"

#include <numeric>

#include "core/every_dimension.hpp"
#include "core/order.hpp"

namespace bernal {

template <int D>
FlyingSpheres<D>::FlyingSpheres(const SpheresInBox& in_box, int axes)
    : edges_(*in_box.task.target_edges),
      drawn_(in_box.spheres.r),
      margin_(std::max(1e-10, 4 * tolerance::growth(edges_.maxCoeff() / std::ranges::min(drawn_)))),
      queue_(largest_first(drawn_)),
      mean_radius_(std::accumulate(drawn_.begin(), drawn_.end(), 0.0) / static_cast<double>(drawn_.size())),
      smallest_(std::ranges::min(drawn_)),
      largest_(std::ranges::max(drawn_)),
      skin_(std::min(0.3, 0.6 / D) * 2 * mean_radius_),
      axes_(axes) {
  for (int k = 0; k < D; ++k) repeats_[k] = !in_box.task.has_wall(k);
  for (const double r : drawn_) whole_volume_ += std::pow(r / mean_radius_, D);
  const auto n = static_cast<Eigen::Index>(drawn_.size());
  x.resize(n, D);
  v.resize(n, D);
  sort();
}

template <int D>
bool FlyingSpheres<D>::is_small() const {
  for (int k = 0; k < D; ++k)
    if (repeats_[k] && edges_[k] < 4 * largest_ + 2 * skin_) return true;
  return false;
}

template <int D>
void FlyingSpheres<D>::wrap_all() {
  for (std::size_t i = 0; i < size(); ++i)
    for (int k = 0; k < D; ++k) wrap(x(static_cast<Eigen::Index>(i), k), k);
}

template <int D>
void FlyingSpheres<D>::sort() {
  grid_.emplace(edges_, repeats_, 2 * largest_ + skin_, 0.5 * skin_, std::max<std::size_t>(size(), 64),
                axes_);
  grid_->set_largest(largest_);
  grid_->sort(columns_of(x), r_, size());
  pairs_.clear();
  for (Id i = 0; i < size(); ++i) {
    grid_->for_each_near(center(i).data(), r_[i] + skin_, [&](Id j, double) {
      if (j > i) pairs_.push_back({i, j});
    });
  }
}

template <int D>
bool FlyingSpheres<D>::is_free(const Vector<D>& c, double r) const {
  return !grid_->any_near(c.data(), r + 2 * margin_ * largest_, [&](Id j, double squared) {
    const double limit = (1 + margin_) * (r + r_[j]);
    return squared < limit * limit;
  });
}

template <int D>
bool FlyingSpheres<D>::push_into_room(Vector<D>& c, double r, int pushes) const {
  const double wide = (1 + 1e-6) * r;  // so that a push ends beyond contact and not in it
  for (int push = 0;; ++push) {
    Vector<D> way = Vector<D>::Zero();
    int met = 0;
    double deepest = 0;
    grid_->for_each_near(c.data(), wide + 2e-6 * largest_, [&](Id j, double squared) {
      const double limit = (1 + 1e-6) * (r + r_[j]);
      if (!(squared < limit * limit)) return;
      const double d = std::sqrt(squared);
      deepest = std::max(deepest, limit - d);
      ++met;
      if (d > 0) way += nearest(c - center(j)) * (limit / d - 1);
    });
    if (met == 0) return is_free(c, r);
    if (push == pushes || !(way.squaredNorm() > 1e-4 * deepest * deepest)) return false;
    c += way;
    for (int k = 0; k < D; ++k) {
      wrap(c[k], k);
      if (!repeats_[k]) c[k] = std::clamp(c[k], low(r), high(k, r));
    }
  }
}

template <int D>
void FlyingSpheres<D>::accept(std::size_t place, const Vector<D>& c, Random& random) {
  const Id tag = queue_[place], i = static_cast<Id>(size());
  const double r = drawn_[tag];
  grid_->for_each_near(c.data(), r + skin_, [&](Id j, double) { pairs_.push_back({j, i}); });
  queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(place));
  tags_.push_back(tag);
  r_.push_back(r);
  mass_.push_back(std::pow(r / mean_radius_, D));
  volume_ += mass_.back();
  grid_->add(c.data(), r);
  set_row(x, i, c);
  set_velocity(i, thermal(i, random));
}

template <int D>
std::vector<typename FlyingSpheres<D>::Id> FlyingSpheres<D>::write_to(Spheres<dynamic>& drawn) const {
  for (Id i = 0; i < size(); ++i) {
    Vector<D> c = center(i);
    for (int k = 0; k < D; ++k) wrap(c[k], k);
    drawn.set_center(tags_[i], c);
  }
  std::vector<Id> numbers = tags_;
  std::ranges::sort(numbers);
  return numbers;
}

#define BERNAL_INSTANTIATE(D) template class FlyingSpheres<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
