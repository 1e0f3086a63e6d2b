#pragma once
#include <span>
#include <vector>

#include "core/archive.hpp"
#include "near/cell_grid.hpp"
#include "near/counting_sort.hpp"
#include "work/free_of_overlap.hpp"

namespace bernal {

/// A sphere as one record, since its members are read together.
template <int D>
struct PlacedSphere {
  using ArchivedAsBytes = void;
  Vector<D> center;
  double r;
};

/// The spheres of a periodic box [0, edges), without a search. A sphere has a number, which never changes,
/// and a slot, the index at which it is stored.
template <int D>
class Slots {
 public:
  using Slot = std::uint32_t;

  Slots(const Boundary<D>& box, const Spheres<D>& spheres) : box_(box) {
    spheres_.reserve(spheres.size());
    for (std::size_t i = 0; i < spheres.size(); ++i) spheres_.push_back({spheres.center(i), spheres.r[i]});
  }

  std::size_t size() const { return spheres_.size(); }
  const PlacedSphere<D>& operator[](Slot slot) const { return spheres_[slot]; }
  Slot slot_of(std::uint32_t number) const { return slot_of_[number]; }
  const Boundary<D>& box() const { return box_; }

  void write_to(Spheres<D>& spheres) const {
    for (std::size_t i = 0; i < spheres_.size(); ++i) spheres.set_center(i, spheres_[slot_of_[i]].center);
  }

 protected:
  void carry_along(const Vector<D>& edges) {
    const Vector<D> factor = edges.cwiseQuotient(box_.edges);
    for (PlacedSphere<D>& sphere : spheres_)
      for (int k = 0; k < D; ++k) sphere.center[k] = carried_along(sphere.center[k], factor[k], edges[k]);
    box_.edges = edges;
  }

  void archive_slots(Archive& a) { a(box_, spheres_, slot_of_); }

  Boundary<D> box_;
  std::vector<PlacedSphere<D>> spheres_;  // by slot
  std::vector<Slot> slot_of_;             // by number
};

/// The spheres of a periodic box as Zhao, Li & Liu keep them: each cell of the background grid (`CellGrid`)
/// has a doubly linked list, and a sphere that moves into another cell changes its list. Slots are given
/// once, in the order of the cells, so that near spheres are near in memory at first.
template <int D>
class LinkedCells : public Slots<D> {
 public:
  using typename Slots<D>::Slot;

  /// Precondition: centres are in the box; 0 < r_min <= all radii <= r_max.
  LinkedCells(const Boundary<D>& box, const Spheres<D>& spheres, double r_min, double r_max)
      : Slots<D>(box, spheres), grid_(box, r_min, r_max, spheres.size()) {
    const CellLayout<D>& layout = grid_.layout();
    this->slot_of_.clear();
    for (const PlacedSphere<D>& s : this->spheres_)
      this->slot_of_.push_back(layout.cell_of(layout.levels()[layout.level_of(s.r)], s.center));
    std::vector<std::uint32_t> start;
    counting_sort(this->slot_of_, layout.cell_count(), start);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Slot slot = this->slot_of_[i];
      this->spheres_[slot] = {spheres.center(i), spheres.r[i]};
      grid_.insert(slot, spheres.center(i), spheres.r[i]);
    }
  }

  void begin_sweep() {}

  /// Calls visit(slot) for every sphere that has an image whose surface is nearer to c than `reach`, and
  /// perhaps for others.
  template <class Visit>
  void for_each_near(const Vector<D>& c, double reach, Visit&& visit) const {
    grid_.for_each_near(c, reach, visit);
  }
  /// Sorts the results of a search into the order of the lists. Here they are in that order already.
  void arrange(std::span<Slot>, const Vector<D>&, double) const {}

  /// Moves a sphere; its centre is wrapped into the box.
  void move(Slot slot, const Vector<D>& to) {
    Vector<D>& center = this->spheres_[slot].center;
    center = this->box_.wrap(to);
    grid_.move(slot, center);
  }
  void grow(const Vector<D>& edges) {
    this->carry_along(edges);
    grid_.rescale(edges);
  }
  void archive(Archive& a) {
    this->archive_slots(a);
    a(grid_);
  }

 private:
  CellGrid<D> grid_;
};

}  // namespace bernal
