#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "hard/home_grid.hpp"
#include "near/cell_grid.hpp"
#include "near/partial_grid.hpp"
#include "near/point_grid.hpp"
#include "near/sphere_tree.hpp"
#include "soft/fixed_point_grid.hpp"
#include "support/sorted_cells.hpp"

// Every index of spheres in a box [0, edges) that repeats itself, asked in the same way: `near(c, visit)`
// calls visit(number) at least once for each sphere with a surface nearer than `reach` to c, in any image.
namespace bernal::test {

template <int D>
struct AllPairs {
  Spheres<D> spheres;
  Boundary<D> box;
  double reach;

  AllPairs(const Spheres<D>& all, const Vector<D>& edges, double within)
      : spheres(all), box{edges}, reach(within) {}

  bool is_near(const Vector<D>& c, std::uint32_t i) const {
    const double limit = reach + spheres.r[i];
    return box.minimum_image(spheres.center(i) - c).squaredNorm() < limit * limit;
  }
  double smallest() const { return std::ranges::min(spheres.r); }
  double largest() const { return std::ranges::max(spheres.r); }

  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    for (std::uint32_t i = 0; i < spheres.size(); ++i)
      if (is_near(c, i)) visit(i);
  }
};

template <int D>
struct InCellGrid : AllPairs<D> {
  CellGrid<D> grid;

  InCellGrid(const Spheres<D>& all, const Vector<D>& edges, double within)
      : AllPairs<D>(all, edges, within), grid(this->box, this->smallest(), this->largest(), all.size()) {
    for (std::uint32_t i = 0; i < all.size(); ++i) grid.insert(i, all.center(i), all.r[i]);
  }
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    grid.for_each_near(c, this->reach, [&](std::uint32_t i) {
      if (this->is_near(c, i)) visit(i);
    });
  }
};

template <int D>
struct InPointGrid : AllPairs<D> {
  PointGrid<D> grid;
  double farthest;

  InPointGrid(const Spheres<D>& all, const Vector<D>& edges, double within)
      : AllPairs<D>(all, edges, within),
        grid(all, this->box, within + this->largest()),
        farthest(within + this->largest()) {}
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    grid.for_each_near(c, farthest, [&](std::uint32_t i, const Vector<D>& d) {
      const double limit = this->reach + this->spheres.r[i];
      if (d.squaredNorm() < limit * limit) visit(i);
    });
  }
};

template <int D>
struct InPartialGrid : AllPairs<D> {
  PartialGrid grid;

  InPartialGrid(const Spheres<D>& all, const Vector<D>& edges, double within)
      : AllPairs<D>(all, edges, within), grid(edges, all_axes(), within + this->largest(), 0, all.size()) {
    grid.set_largest(this->largest());
    grid.sort(columns_of(all.x), all.r, all.size());
  }
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    grid.for_each_near(c.data(), this->reach, [&](std::uint32_t i, double) { visit(i); });
  }
  static PartialGrid::EachAxis<bool> all_axes() {
    PartialGrid::EachAxis<bool> axes{};
    std::fill_n(axes.begin(), D, true);
    return axes;
  }
};

template <int D>
struct InSphereTree : AllPairs<D> {
  SphereTree<D> tree;

  InSphereTree(const Spheres<D>& all, const Vector<D>& edges, double within)
      : AllPairs<D>(all, edges, within), tree(all, this->box) {}
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    tree.for_each_leaf(
        c, [&](double squared, double r) { return squared < (this->reach + r) * (this->reach + r); },
        [&](const auto& leaf, const Vector<D>& shift, double) {
          for (std::uint32_t k = leaf.first; k < leaf.last; ++k) {
            const double limit = this->reach + tree.radius(k);
            if ((tree.center(k) + shift - c).squaredNorm() < limit * limit) visit(tree.id(k));
          }
        });
  }
};

/// All images next to the box stand in the tree themselves.
template <int D>
struct InBoxTree : AllPairs<D> {
  BoxTree<D> tree;

  InBoxTree(const Spheres<D>& all, const Vector<D>& edges, double within) : AllPairs<D>(all, edges, within) {
    int images = 1;
    for (int k = 0; k < D; ++k) images *= 3;
    std::vector<Bounds<D>> boxes;
    for (int image = 0; image < images; ++image)
      for (std::uint32_t i = 0; i < all.size(); ++i) {
        Vector<D> c = all.center(i);
        for (int k = 0, digits = image; k < D; ++k, digits /= 3) c[k] += (digits % 3 - 1) * edges[k];
        boxes.push_back({c.array() - all.r[i], c.array() + all.r[i]});
      }
    tree = BoxTree<D>(boxes, 8);
  }
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    tree.for_each_near(c, this->reach, [&](std::uint32_t image) {
      const auto i = static_cast<std::uint32_t>(image % this->spheres.size());
      if (this->is_near(c, i)) visit(i);
    });
  }
};

template <int D, template <int> class Cells>
struct InSlots : AllPairs<D> {
  Cells<D> cells;
  std::vector<std::uint32_t> number_of;

  InSlots(const Spheres<D>& all, const Vector<D>& edges, double within)
      : AllPairs<D>(all, edges, within),
        cells(this->box, all, this->smallest(), this->largest()),
        number_of(all.size()) {
    for (std::uint32_t i = 0; i < all.size(); ++i) number_of[cells.slot_of(i)] = i;
  }
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    cells.for_each_near(c, this->reach, [&](std::uint32_t slot) {
      const double limit = this->reach + cells[slot].r;
      if (this->box.minimum_image(cells[slot].center - c).squaredNorm() < limit * limit)
        visit(number_of[slot]);
    });
  }
};
template <int D>
using InLinkedCells = InSlots<D, LinkedCells>;
template <int D>
using InSortedCells = InSlots<D, SortedCells>;

template <int D>
struct InHomeGrid : AllPairs<D> {
  HomeGrid<D> grid;

  InHomeGrid(const Spheres<D>& all, const Vector<D>& edges, double within) : AllPairs<D>(all, edges, within) {
    grid.start(edges, all.r);
    for (std::uint32_t i = 0; i < all.size(); ++i) grid.insert(i, all.center(i), all.r[i]);
  }
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    grid.for_each_near(c, this->reach, visit);
  }
};

template <int D>
struct InFixedPointGrid : AllPairs<D> {
  FixedPointGrid<D> grid;
  std::vector<std::uint32_t> number_of;
  mutable std::vector<typename FixedPointGrid<D>::Row> rows;

  InFixedPointGrid(const Spheres<D>& all, const Vector<D>& edges, double within)
      : AllPairs<D>(all, edges, within), number_of(all.size()) {
    std::vector<FixedPlace<D>> places;
    for (std::uint32_t i = 0; i < all.size(); ++i) places.push_back(place_of(all.center(i)));
    const auto rank = grid.sort(edges, (within + this->largest()) * (1 + 1e-6), places, all.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) number_of[rank[i]] = i;
  }
  template <class Visit>
  void near(const Vector<D>& c, Visit&& visit) const {
    grid.rows_near(place_of(c), rows);
    for (const auto& row : rows)
      for (std::uint32_t k = row.first; k < row.last; ++k)
        if (this->is_near(c, number_of[k])) visit(number_of[k]);
  }
  FixedPlace<D> place_of(const Vector<D>& c) const {
    FixedPlace<D> place{};
    for (int k = 0; k < D; ++k) place.x[k] = to_fixed(c[k], this->box.edges[k]);
    return place;
  }
};

}  // namespace bernal::test
