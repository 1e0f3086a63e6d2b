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

/// Near-neighbour lists that each sphere renews for itself: every sphere has a home, and is free to fly
/// within a shell around it, its `freedom`; neighbours are all that it could meet before one of the two has
/// left its shell. Leaving is an event: `settle` gives the sphere a new home and mends its list and those of
/// the others.
///
/// Invariant: two spheres are neighbours, each in the list of the other, if their homes are nearer than the
/// sum of their radii and freedoms, minimum image, and only if they are not farther than that by more than
/// what `HomeGrid` rounds. Cost: `build` and `settle` about 1 µs a sphere where sizes are alike; memory
/// about 300 bytes a sphere. Source: Donev, Torquato & Stillinger, J. Comput. Phys. 202, 737 (2005), with
/// shells of their own size.
template <int D>
class Shells {
 public:
  using Id = std::uint32_t;

  /// `radii` are the largest that the spheres grow to while these lists last; homes lie in [0, edge).
  void build(const std::vector<Vector<D>>& homes, const std::vector<double>& radii,
             const std::vector<double>& freedoms, const Vector<D>& edges);

  std::span<const Id> neighbors(Id i) const { return lists_.of(shells_[i].list); }
  std::size_t longest_list() const { return lists_.longest(); }
  double mean_list() const;
  const Vector<D>& home(Id i) const { return shells_[i].home; }
  double freedom(Id i) const { return shells_[i].freedom; }

  /// Ask the memory for the shell of sphere i, and then for its list.
  void prefetch(Id i) const { bernal::prefetch(&shells_[i]); }
  void prefetch_list(Id i) const { lists_.prefetch(shells_[i].list); }
  /// Ask it for what `settle` will look at.
  void prefetch_settling(Id i, const Vector<D>& home) const { grid_.prefetch_near(home, shells_[i].reach); }

  /// A new home, in [0, edge).
  void settle(Id i, const Vector<D>& home);

  void archive(Archive& a) { a(shells_, lists_, grid_); }

 private:
  struct alignas(D == 3 ? 64 : 16) Shell {
    using ArchivedAsBytes = void;
    Vector<D> home;
    double freedom, reach;  // reach: radius and freedom
    NeighborPool::List list;
  };

  const Made made_{"neighbour shells"};
  LargePageVector<Shell> shells_;
  NeighborPool lists_;
  HomeGrid<D> grid_;
  std::vector<Id> before_, after_;  // neighbours of the one that settles, sorted
};

}  // namespace bernal
