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
  lists_.start(n, mean_list());
  shells_.resize(n);
  std::vector<double> reaches(n);
  for (std::size_t i = 0; i < n; ++i) {
    reaches[i] = radii[i] + freedoms[i];
    shells_[i] = {homes[i], freedoms[i], reaches[i], lists_.make()};
  }
  grid_.start(edges, reaches);
  for (Id i = 0; i < n; ++i) {
    after_.clear();
    grid_.for_each_near(homes[i], shells_[i].reach, [&](Id j) { after_.push_back(j); });
    lists_.replace(shells_[i].list, after_);
    for (const Id j : after_) lists_.append(shells_[j].list, i);
    grid_.insert(i, homes[i], shells_[i].reach);
  }
}

template <int D>
double Shells<D>::mean_list() const {
  if (shells_.empty()) return 0;
  std::size_t sum = 0;
  for (const Shell& shell : shells_) sum += shell.list.count;
  return static_cast<double>(sum) / static_cast<double>(shells_.size());
}

/// Most neighbours stay neighbours: only the lists of those that come or go are touched.
template <int D>
void Shells<D>::settle(Id i, const Vector<D>& home) {
  Shell& shell = shells_[i];
  shell.home = home;
  grid_.move(i, home, shell.reach);
  before_.assign(neighbors(i).begin(), neighbors(i).end());
  after_.clear();
  grid_.for_each_near(home, shell.reach, [&](Id j) { after_.push_back(j); });
  std::ranges::sort(before_);
  std::ranges::sort(after_);
  after_.erase(std::ranges::lower_bound(after_, i));
  lists_.replace(shell.list, after_);
  for_each_only_in(before_, after_, [&](Id j) { lists_.remove(shells_[j].list, i); });
  for_each_only_in(after_, before_, [&](Id j) { lists_.append(shells_[j].list, i); });
}

#define BERNAL_INSTANTIATE(D) template class Shells<D>;
BERNAL_IN_FLYING_DIMENSIONS(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
