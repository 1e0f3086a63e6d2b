#include "hard/shells.hpp"

#include <algorithm>

namespace bernal {

template <int D>
void Shells<D>::build(std::vector<Vector<D>> homes, const std::vector<double>& radii,
                      std::vector<double> freedoms, const Vector<D>& edges) {
  const std::size_t n = homes.size();
  homes_ = std::move(homes);
  freedoms_ = std::move(freedoms);
  reach_.resize(n);
  for (std::size_t i = 0; i < n; ++i) reach_[i] = radii[i] + freedoms_[i];
  const auto [least, most] = std::ranges::minmax(reach_);
  lists_.start(n, lists_.mean());
  grid_.start(edges, least, most, n);
  for (Id i = 0; i < n; ++i) {
    grid_.for_each_near(homes_[i], reach_[i], [&](Id j) {
      lists_.append(i, j);
      lists_.append(j, i);
    });
    grid_.insert(i, homes_[i], reach_[i]);
  }
}

template <int D>
void Shells<D>::settle(Id i, const Vector<D>& home) {
  for (const Id j : lists_.of(i)) lists_.remove(j, i);
  lists_.clear(i);
  homes_[i] = home;
  grid_.move(i, home, reach_[i]);
  grid_.for_each_near(home, reach_[i], [&](Id j) {
    if (j == i) return;
    lists_.append(i, j);
    lists_.append(j, i);
  });
}

template class Shells<2>;
template class Shells<3>;
template class Shells<4>;
template class Shells<5>;
template class Shells<6>;

}  // namespace bernal
