#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "core/archive.hpp"
#include "soft/linked_cells.hpp"

namespace bernal {

/// The same as `LinkedCells`, for whoever asks, but in an array sorted by the cells (a counting sort): a cell
/// is a run of slots, and cells that follow each other along the first axis are one run.
///
/// A sphere that moves stays in its slot. Searches reach farther by as much as anything on a level has moved
/// since the array was sorted; between sweeps it is sorted anew where that has become too far. What a search
/// finds stands in the order of the linked lists, last come first, so that sums over it are the same to the
/// bit: with each sphere goes the cell that it is in, and when it came there. Only what has changed its cell
/// since the last sort can be out of order.
///
/// What it buys: sweeps of the published loop on linked lists take 1.03 to 1.2 of the time from 10^3 to 10^5
/// equal spheres, 0.9 for 10^6 (data/results/lists.md).
///
/// Cost: sorting O(N), about 50 ns a sphere. Memory: 60 bytes a sphere in three dimensions, twice that while
/// it is sorted, and 4 a cell.
template <int D>
class SortedCells : public Slots<D> {
 public:
  using typename Slots<D>::Slot;

  /// As of LinkedCells.
  SortedCells(const Boundary<D>& box, const Spheres<D>& spheres, double r_min, double r_max)
      : Slots<D>(box, spheres),
        layout_({box.origin, box.origin + box.edges}, box, r_min, r_max, spheres.size()),
        motion_(layout_.levels().size()) {
    this->slot_of_.resize(spheres.size());
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
      const std::size_t level = layout_.level_of(spheres.r[i]);
      const std::uint32_t cell = layout_.cell_of(layout_.levels()[level], spheres.center(i));
      tags_.push_back({clock_++, cell, i, static_cast<std::uint8_t>(level), false});
      ++motion_[level].spheres;
    }
    sort();
  }

  void begin_sweep() {
    bool far = static_cast<double>(strays_) > most_strays * static_cast<double>(this->size());
    for (std::size_t l = 0; l < motion_.size(); ++l) {
      Motion& m = motion_[l];
      m.moved += m.step;
      m.step = 0;
      far = far || m.moved * layout_.levels()[l].inverse_edge.maxCoeff() > most_moved;
    }
    if (far) sort();
  }

  template <class Visit>
  void for_each_near(const Vector<D>& c, double reach, Visit&& visit) const {
    for (std::size_t l = 0; l < motion_.size(); ++l) {
      if (motion_[l].spheres == 0) continue;
      const Level& level = layout_.levels()[l];
      CellLayout<D>::any_run(level, block_to_search(l, c, reach), [&](std::size_t first, std::size_t end) {
        const Slot last = start_[end];
        for (Slot slot = start_[first]; slot < last; ++slot) visit(slot);
        return false;
      });
    }
  }

  void arrange(std::span<Slot> found, const Vector<D>& c, double reach) const {
    if (strays_ == 0 || std::ranges::none_of(found, [&](Slot s) { return tags_[s].strayed; })) return;
    std::vector<Turn> turns;
    for (const Slot slot : found) turns.push_back(turn_of(slot, c, reach));
    std::ranges::sort(turns);
    for (std::size_t n = 0; n < found.size(); ++n) found[n] = turns[n].slot;
  }

  void move(Slot slot, const Vector<D>& to) {
    Vector<D>& center = this->spheres_[slot].center;
    Tag& tag = tags_[slot];
    Motion& motion = motion_[tag.level];
    motion.step = std::max(motion.step, (to - center).cwiseAbs().maxCoeff());
    center = this->box_.wrap(to);
    const std::uint32_t cell = layout_.cell_of(layout_.levels()[tag.level], center);
    if (cell == tag.cell) return;
    strays_ += !tag.strayed;
    tag.came = clock_++;
    tag.cell = cell;
    tag.strayed = true;
  }
  void grow(const Vector<D>& edges) {
    const double factor = edges.cwiseQuotient(this->box_.edges).maxCoeff();
    for (Motion& m : motion_) {
      m.moved *= factor;
      m.step *= factor;
    }
    this->carry_along(edges);
    layout_.rescale(edges);
  }
  void archive(Archive& a) {
    this->archive_slots(a);
    a(layout_, motion_, tags_, start_, clock_, strays_);
  }

 private:
  /// Of a cell's edge, and of the spheres.
  static constexpr double most_moved = 0.1, most_strays = 0.02;

  using Level = typename CellLayout<D>::Level;
  struct Tag {
    using ArchivedAsBytes = void;
    std::uint64_t came;    // when, to its cell
    std::uint32_t cell;    // that it is in
    std::uint32_t number;  // of the sphere
    std::uint8_t level;
    bool strayed;  // to another cell since the array was sorted
  };
  /// On a level, since the array was sorted: the most that any sphere can have moved along an axis before
  /// this sweep, and the longest step in this sweep, in which each sphere moves once.
  struct Motion {
    using ArchivedAsBytes = void;
    double moved = 0, step = 0;
    std::size_t spheres = 0;
  };
  /// When the lists come to a sphere.
  struct Turn {
    std::size_t level, cell;
    std::uint64_t age;
    Slot slot;
    auto operator<=>(const Turn&) const = default;
  };

  auto block_to_search(std::size_t l, const Vector<D>& c, double reach) const {
    const Level& level = layout_.levels()[l];
    const double half = reach + level.largest_radius;
    auto block = layout_.block_around(level, c, half + motion_[l].moved + motion_[l].step);
    for (int k = 0; k < D; ++k)
      if (block[k].count == level.cells[k])  // whole axes begin where lists do
        block[k].first = layout_.block_around(level, c, half)[k].first;
    return block;
  }

  Turn turn_of(Slot slot, const Vector<D>& c, double reach) const {
    const Tag& tag = tags_[slot];
    const Level& level = layout_.levels()[tag.level];
    const auto block = layout_.block_around(level, c, reach + level.largest_radius);
    std::size_t cell = tag.cell - level.offset, position = 0, stride = 1;
    for (int k = 0; k < D; ++k) {
      const auto cells = static_cast<std::size_t>(level.cells[k]);
      position += stride * ((cell % cells + cells - static_cast<std::size_t>(block[k].first)) % cells);
      stride *= cells;
      cell /= cells;
    }
    return {tag.level, position, ~tag.came, slot};
  }

  void sort() {
    const std::size_t count = this->size();
    std::vector<std::uint32_t> place(count), order(count);
    for (std::size_t slot = 0; slot < count; ++slot) place[slot] = tags_[slot].cell;
    counting_sort(place, layout_.cell_count(), start_);
    for (Slot slot = 0; slot < count; ++slot) order[place[slot]] = slot;
    const auto later = [&](Slot a, Slot b) { return tags_[a].came > tags_[b].came; };
    for (std::size_t cell = 0; cell + 1 < start_.size(); ++cell)
      if (start_[cell + 1] > start_[cell] + 1)
        std::sort(order.begin() + start_[cell], order.begin() + start_[cell + 1], later);

    std::vector<PlacedSphere<D>> spheres(count);
    std::vector<Tag> tags(count);
    for (Slot slot = 0; slot < count; ++slot) {
      spheres[slot] = this->spheres_[order[slot]];
      tags[slot] = tags_[order[slot]];
      tags[slot].strayed = false;
      this->slot_of_[tags[slot].number] = slot;
    }
    this->spheres_.swap(spheres);
    tags_.swap(tags);
    strays_ = 0;
    for (Motion& m : motion_) m.moved = m.step = 0;
  }

  CellLayout<D> layout_;
  std::vector<Motion> motion_;        // by level
  std::vector<Tag> tags_;             // by slot
  std::vector<std::uint32_t> start_;  // of each cell, and the end
  std::uint64_t clock_ = 0;
  std::size_t strays_ = 0;
};

}  // namespace bernal
