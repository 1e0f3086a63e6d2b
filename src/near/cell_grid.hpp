#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/core/vector.hpp"
#include "core/archive.hpp"
#include "near/cell_layout.hpp"

namespace bernal {

/// A background grid with doubly linked lists, hierarchical in the radius, of a region that is open or
/// repeats itself along each axis. Which cells there are stands at `CellLayout`; levels without spheres cost
/// nothing.
///
/// The grid stores ids, not coordinates. Invariant: sphere id is in exactly one list, that of the cell
/// that holds its centre on the level of its radius; who came last stands first.
///
/// Cost: insert and move O(1); a query O(levels + spheres met). Memory: 16 bytes a sphere, 4 a cell.
/// Source: Zhao, Li & Liu 2007, figure 7 (one level).
template <int D>
class CellGrid {
 public:
  using Id = std::uint32_t;
  static constexpr Id none = 0xFFFFFFFF;

  /// Radii to come lie in [r_min, r_max], 0 < r_min; `expected` is about how many spheres will come.
  CellGrid(const Bounds<D>& bounds, double r_min, double r_max, std::size_t expected)
      : CellGrid(bounds, {}, r_min, r_max, expected) {}
  /// Of a box that is periodic on every axis k: all edges are above 0.
  CellGrid(const Boundary<D>& box, double r_min, double r_max, std::size_t expected)
      : CellGrid({box.origin, box.origin + box.edges}, box, r_min, r_max, expected) {}
  /// Of a region within `bounds` along the open axes, and of a period along the others.
  CellGrid(const Bounds<D>& bounds, const Boundary<D>& boundary, double r_min, double r_max,
           std::size_t expected);

  /// A box [0, edge) that is periodic on every axis and all centres have been multiplied by the same factor
  /// on each axis; the box has these edges now. Spheres stay in their cells. Radii have not changed: what a
  /// query finds is what is near in the new box. Cost: O(levels).
  void rescale(const Vector<D>& edges) { layout_.rescale(edges); }

  /// Precondition: `id` is not in the grid, r in [r_min, r_max].
  void insert(Id id, const Vector<D>& center, double r);

  /// Tells the grid where sphere `id` is now. Precondition: it is in the grid.
  void move(Id id, const Vector<D>& center) {
    const Link& l = links_[id];
    const std::uint32_t cell = layout_.cell_of(layout_.levels()[l.level], center);
    if (cell == l.cell) return;
    const std::uint8_t level = l.level;
    unlink(id);
    link(id, cell, level);
  }

  void clear();

  /// Calls visit(id) until it returns true, for every sphere whose bounding cube, blown up by `reach`, may
  /// hold c: at least for all with max_k |c - c_id|_k < reach + r_id, which includes all whose surface is
  /// nearer than `reach`. Along periodic axes that means any image of the sphere; none is visited twice.
  /// Returns whether it returned true.
  template <class Visit>
  bool any_near(const Vector<D>& c, double reach, Visit&& visit) const {
    if constexpr (D == 2 || D == 3) return walk(c, reach, visit);
    using Plain = std::remove_reference_t<Visit>;
    return search(
        c, reach, [](void* it, Id id) -> bool { return (*static_cast<Plain*>(it))(id); },
        const_cast<void*>(static_cast<const void*>(std::addressof(visit))));
  }

  /// As `any_near`, for all of them.
  template <class Visit>
  void for_each_near(const Vector<D>& c, double reach, Visit&& visit) const {
    any_near(c, reach, [&](Id id) {
      visit(id);
      return false;
    });
  }

  const CellLayout<D>& layout() const { return layout_; }
  std::size_t level_count() const { return layout_.levels().size(); }
  std::size_t cell_count() const { return heads_.size(); }

  /// Which spheres are in which lists, in a grid that was made alike.
  void archive(Archive& a) { a(layout_, spheres_on_, heads_, links_); }

 private:
  struct Link {
    using ArchivedAsBytes = void;
    Id next = none;
    Id previous = none;
    std::uint32_t cell = 0;
    std::uint8_t level = 0;
  };

  template <class Visit>
  bool walk(const Vector<D>& c, double reach, Visit&& visit) const {
    for (std::size_t l = 0; l < spheres_on_.size(); ++l) {
      if (spheres_on_[l] == 0) continue;
      const auto& level = layout_.levels()[l];
      const auto block = layout_.block_around(level, c, reach + level.largest_radius);
      if (CellLayout<D>::any_run(level, block, [&](std::size_t first, std::size_t end) {
            for (std::size_t cell = first; cell < end; ++cell)
              for (Id id = heads_[cell]; id != none; id = links_[id].next)
                if (visit(id)) return true;
            return false;
          }))
        return true;
    }
    return false;
  }

  /// The same, compiled once for every dimension in which the 3^D cells cost more than a call for each
  /// sphere.
  bool search(const Vector<D>& c, double reach, bool (*visitor)(void* it, Id id), void* it) const;

  void link(Id id, std::uint32_t cell, std::uint8_t level) {
    Link& l = links_[id];
    l = {heads_[cell], none, cell, level};
    if (l.next != none) links_[l.next].previous = id;
    heads_[cell] = id;
  }
  void unlink(Id id) {
    const Link& l = links_[id];
    (l.previous == none ? heads_[l.cell] : links_[l.previous].next) = l.next;
    if (l.next != none) links_[l.next].previous = l.previous;
  }

  CellLayout<D> layout_;
  std::vector<std::size_t> spheres_on_;  // of each level
  std::vector<Id> heads_;
  std::vector<Link> links_;
};

}  // namespace bernal
