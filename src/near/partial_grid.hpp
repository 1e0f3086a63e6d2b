#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "core/archive.hpp"

namespace bernal {

/// Spheres sorted by the cells of a grid over only the first few axes, for searches of one reach in any
/// dimension. Beyond three or four dimensions the 3^D cells around a point are more than the spheres that are
/// there; a column of cells without end along the other axes holds them one after the other, which the
/// processor takes several at a time. No axis at all is the comparison of all pairs.
///
/// The axes are those of a box [0, edge); where one repeats itself, distances are those to the nearest image.
/// Spheres may move after `sort`: `update` takes their places, and queries look `slack` farther. Those that
/// `add` brings stay unsorted: queries look at all of them while they are few, then find them in chains, a
/// chain a cell.
///
/// The dimension is known when the program runs: the inner loops run over spheres, not over axes.
///
/// What it buys: to be filled and asked once for each of 10^3 spheres takes a sixth of the time of a
/// `CellGrid` in five dimensions, a fifth in seven, as long as that in three; of 10^4 in five dimensions a
/// quarter (tests/bench/near_bench.cpp).
///
/// Cost: sort O(N); a query about 3^k cells and N (3 reach / edge)^k spheres for k axes; k is that of the
/// least `cost_of` if it is left to the grid. Memory: 8 D + 12 bytes a sphere.
class PartialGrid {
 public:
  using Id = std::uint32_t;
  template <class T>
  using EachAxis = std::array<T, max_dimension>;
  /// Coordinates of all spheres, an array an axis.
  using Columns = EachAxis<const double*>;
  static constexpr int automatic = -1;

  /// `repeats[k]` says whether axis k is periodic. No query will reach farther than `reach` and `slack`.
  PartialGrid(const Vector<dynamic>& edges, const EachAxis<bool>& repeats, double reach, double slack,
              std::size_t expected, int axes = automatic);

  int axes() const { return axes_; }
  std::size_t size() const { return ids_.size(); }
  /// How many came by `add` since the last `sort`.
  std::size_t unsorted() const { return ids_.size() - start_.back(); }

  /// Takes the first `n` spheres, with their places.
  void sort(const Columns& x, const std::vector<double>& r, std::size_t n);
  /// The places of all spheres now, none of them farther than `slack` from where it was sorted.
  void update(const Columns& x);
  /// Sphere `size()`, at c, a coordinate an axis.
  void add(const double* c, double r);

  /// Calls visit(id, squared distance of the nearest images) until it returns true for spheres with a surface
  /// nearer than `reach` to c, a component of which may be up to half an edge outside the box. Returns
  /// whether it returned true.
  template <class Visit>
  bool any_near(const double* c, double reach, Visit&& visit) const {
    using Plain = std::remove_reference_t<Visit>;
    return search(
        c, reach,
        [](void* it, Id id, double squared) -> bool { return (*static_cast<Plain*>(it))(id, squared); },
        const_cast<void*>(static_cast<const void*>(std::addressof(visit))));
  }

  /// The same for all of them.
  template <class Visit>
  void for_each_near(const double* c, double reach, Visit&& visit) const {
    any_near(c, reach, [&](Id id, double squared) {
      visit(id, squared);
      return false;
    });
  }

  /// All of its state.
  void archive(Archive& a) {
    a(dimension_, repeats_, period_, slack_, largest_, axes_, cells_, per_length_, start_, x_, r_, ids_,
      last_added_, added_before_);
  }

  /// No sphere is larger; every query reaches so much farther.
  void set_largest(double r) { largest_ = r; }

 private:
  using Visitor = bool (*)(void* it, Id id, double squared);

  std::size_t coordinate(int k, double x) const;
  /// The cell of a place, a coordinate an axis.
  template <class Coordinate>
  std::size_t cell_of(Coordinate&& x) const {
    std::size_t index = 0;
    for (int k = axes_ - 1; k >= 0; --k)
      index = index * static_cast<std::size_t>(cells_[k]) + coordinate(k, x(k));
    return index;
  }
  bool search(const double* c, double reach, Visitor visitor, void* it) const;
  bool look_at(const double* c, double reach, std::size_t first, std::size_t last, Visitor visitor,
               void* it) const;

  int dimension_;
  EachAxis<bool> repeats_;
  EachAxis<double> period_{};
  double slack_;
  double largest_ = 0;
  int axes_ = 0;
  EachAxis<int> cells_{};
  EachAxis<double> per_length_{};
  std::vector<std::uint32_t> start_;  // of each cell, and the number of those that are sorted
  EachAxis<std::vector<double>> x_;
  std::vector<double> r_;
  std::vector<Id> ids_;
  // Of those that are not sorted: the last one in each cell, and of each the one before it.
  std::vector<Id> last_added_, added_before_;
};

/// A column an axis, of arrays or of Eigen's columns.
template <std::size_t D>
PartialGrid::Columns columns_of(const std::array<std::vector<double>, D>& x) {
  PartialGrid::Columns columns{};
  for (std::size_t k = 0; k < D; ++k) columns[k] = x[k].data();
  return columns;
}
template <int D>
PartialGrid::Columns columns_of(const Eigen::Array<double, Eigen::Dynamic, D>& x) {
  PartialGrid::Columns columns{};
  for (int k = 0; k < D; ++k) columns[static_cast<std::size_t>(k)] = x.data() + k * x.rows();
  return columns;
}

}  // namespace bernal
