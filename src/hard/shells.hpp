#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bernal/core/vector.hpp"
#include "core/archive.hpp"
#include "core/large_pages.hpp"
#include "core/made.hpp"
#include "hard/home_grid.hpp"
#include "hard/neighbor_pool.hpp"
#include "hard/prefetch.hpp"

namespace bernal {

/// Near-neighbour lists that each sphere renews separately: every sphere has a home and may fly within a
/// shell around it, of size `freedom`; its neighbours are all spheres that it could meet before either leaves
/// its shell. Leaving is an event: `settle` gives the sphere a new home and updates its list and those of the
/// others.
///
/// Invariant: two spheres are in each other's list if their homes are nearer than the sum of their radii and
/// freedoms, minimum image, and only if they are not farther than that by more than the rounding of
/// `HomeGrid`. Cost: `build` and `settle` about 1 µs a sphere of similar sizes; memory about 300 bytes a
/// sphere. Source: Donev, Torquato & Stillinger, J. Comput. Phys. 202, 737 (2005), with individual shell
/// sizes.
template <int D>
class Shells {
 public:
  using Id = std::uint32_t;

  /// `radii` are the largest that the spheres reach with these lists; homes lie in [0, edge).
  void build(const std::vector<Vector<D>>& homes, const std::vector<double>& radii,
             const std::vector<double>& freedoms, const Vector<D>& edges);

  std::span<const Id> neighbors(Id i) const { return lists_.of(shells_[i].list); }
  std::size_t longest_list() const { return lists_.longest(); }
  double mean_list() const;
  const Vector<D>& home(Id i) const { return shells_[i].home; }
  double freedom(Id i) const { return shells_[i].freedom; }

  /// Prefetch the shell of sphere i, then its list.
  void prefetch(Id i) const { bernal::prefetch(&shells_[i]); }
  void prefetch_list(Id i) const { lists_.prefetch(shells_[i].list); }
  /// Prefetches what `settle` reads.
  void prefetch_settling(Id i, const Vector<D>& home) const { grid_.prefetch_near(home, shells_[i].reach); }

  /// Sets a new home, in [0, edge).
  void settle(Id i, const Vector<D>& home);

  void archive(Archive& a) { a(shells_, lists_, grid_); }

 private:
  struct alignas(D == 3 ? 64 : 16) Shell {
    using ArchivedAsBytes = void;
    Vector<D> home;
    double freedom, reach;  // reach: radius plus freedom
    NeighborPool::List list;
  };

  const Made made_{"neighbour shells"};
  LargePageVector<Shell> shells_;
  NeighborPool lists_;
  HomeGrid<D> grid_;
  std::vector<Id> before_, after_;  // neighbours of the sphere that settles, sorted
};

}  // namespace bernal
