#include "hard/shells.hpp"

#include <algorithm>

namespace bernal {

template <int D>
void Shells<D>::build(const std::vector<Vector<D>>& homes, const std::vector<double>& radii,
                      const std::vector<double>& freedoms, const Vector<D>& edges) {
  const std::size_t n = homes.size();
  places_.resize(n);
  double least = radii[0] + freedoms[0], most = least;
  for (std::size_t i = 0; i < n; ++i) {
    places_[i] = {homes[i], freedoms[i], radii[i] + freedoms[i]};
    least = std::min(least, places_[i].reach);
    most = std::max(most, places_[i].reach);
  }
  lists_.start(n, lists_.mean());
  grid_.start(edges, least, most, n);
  for (Id i = 0; i < n; ++i) {
    const Place& place = places_[i];
    grid_.for_each_near(place.home, place.reach, [&](Id j) {
      lists_.append(i, j);
      lists_.append(j, i);
    });
    grid_.insert(i, place.home, place.reach);
  }
}

template <int D>
void Shells<D>::settle(Id i, const Vector<D>& home) {
  for (const Id j : lists_.of(i)) lists_.remove(j, i);
  lists_.clear(i);
  Place& place = places_[i];
  place.home = home;
  grid_.move(i, home, place.reach);
  grid_.for_each_near(home, place.reach, [&](Id j) {
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
