#include "hard/shells.hpp"

#include <algorithm>

#include "hard/flying_sphere.hpp"

namespace bernal {
namespace {

/// Calls visit(id) for what is in the first of two sorted lists and not in the second.
template <class Visit>
void for_each_only_in(const std::vector<std::uint32_t>& these, const std::vector<std::uint32_t>& others,
                      Visit&& visit) {
  auto other = others.begin();
  for (const std::uint32_t id : these) {
    while (other != others.end() && *other < id) ++other;
    if (other == others.end() || *other != id) visit(id);
  }
}

}  // namespace

template <int D>
void Shells<D>::build(const std::vector<Vector<D>>& homes, const std::vector<double>& radii,
                      const std::vector<double>& freedoms, const Vector<D>& edges) {
  const std::size_t n = homes.size();
  places_.resize(n);
  reaches_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    places_[i] = {homes[i], freedoms[i]};
    reaches_[i] = radii[i] + freedoms[i];
  }
  lists_.start(n, lists_.mean());
  grid_.start(edges, std::ranges::min(reaches_), std::ranges::max(reaches_), n);
  for (Id i = 0; i < n; ++i) {
    after_.clear();
    grid_.find_near(homes[i], reaches_[i], after_);
    lists_.replace(i, after_);
    for (const Id j : after_) lists_.append(j, i);
    grid_.insert(i, homes[i], reaches_[i]);
  }
}

/// Most neighbours stay neighbours: only the lists of those that come or go are touched.
template <int D>
void Shells<D>::settle(Id i, const Vector<D>& home) {
  const double reach = reaches_[i];
  places_[i].home = home;
  grid_.move(i, home, reach);
  before_.assign(lists_.of(i).begin(), lists_.of(i).end());
  after_.clear();
  grid_.find_near(home, reach, after_);
  std::ranges::sort(before_);
  std::ranges::sort(after_);
  after_.erase(std::ranges::lower_bound(after_, i));
  lists_.replace(i, after_);
  for_each_only_in(before_, after_, [&](Id j) { lists_.remove(j, i); });
  for_each_only_in(after_, before_, [&](Id j) { lists_.append(j, i); });
}

#define BERNAL_INSTANTIATE(D) template class Shells<D>;
BERNAL_IN_FLYING_DIMENSIONS(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
