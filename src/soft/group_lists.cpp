#include "soft/group_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bernal {
namespace {

/// Cells for each sphere of a level, at most.
constexpr double cells_per_sphere = 2;
/// Of a cell, in the farthest that two spheres of its level may be apart as neighbours. The cells along the
/// first axis are looked through as one run, `lanes` spheres at a time: few runs, and not much too long.
constexpr std::array<double, 3> cell_widths = {0.5, 1.5, 1.5};

std::size_t level_of(float r, const SoftSizes& sizes) {
  std::size_t l = 0;
  for (float half = sizes.largest / 2; r <= half && l + 1 < sizes.levels; half /= 2) ++l;
  return l;
}

}  // namespace

void RegionCells::choose_levels(std::span<const SoftSphere> spheres, const SoftSizes& sizes) {
  levels_.assign(sizes.levels, SoftLevel{});
  for (const SoftSphere& s : spheres)
    if (s.r > 0) ++levels_[sizes.levels == 1 ? 0 : level_of(s.r, sizes)].spheres;
  std::size_t cells = 0;
  for (std::size_t l = 0; l < sizes.levels; ++l) {
    SoftLevel& level = levels_[l];
    level.largest = std::ldexp(sizes.largest, -static_cast<int>(l));
    level.first_cell = cells;
    double width = 2.0 * (level.largest + skin_), count = 0;
    do {
      for (std::size_t k = 0; k < 3; ++k) {
        const double length = edges_[k] * static_cast<double>(region_.extent[k]) * 0x1p-32;
        level.cells[k] = std::max(1, static_cast<int>(std::min(length / (width * cell_widths[k]), 1e6)));
      }
      count = static_cast<double>(level.cells[0]) * level.cells[1] * level.cells[2];
      width *= 1.1;
    } while (count > cells_per_sphere * static_cast<double>(level.spheres) + 27);
    for (std::size_t k = 0; k < 3; ++k) {
      level.cells_a_unit[k] = level.cells[k] / static_cast<double>(region_.extent[k]);
      level.cells_a_length[k] = level.cells_a_unit[k] / edges_[k] * 0x1p32;
    }
    cells += static_cast<std::size_t>(count);
  }
  start_.assign(cells + 1, 0);
}

void RegionCells::sort(std::span<const SoftSphere> spheres, const SoftRegion& region,
                       const std::array<double, 3>& edges, const SoftSizes& sizes, float skin) {
  region_ = region;
  edges_ = edges;
  skin_ = skin;
  choose_levels(spheres, sizes);
  cell_.resize(spheres.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const SoftSphere& s = spheres[i];
    if (!(s.r > 0)) continue;
    const std::size_t l = sizes.levels == 1 ? 0 : level_of(s.r, sizes);
    const SoftLevel& level = levels_[l];
    const auto at = [&](std::size_t k) {
      const int cell = static_cast<int>(region.offset(s, k) * level.cells_a_unit[k]);
      return static_cast<std::size_t>(std::min(cell, level.cells[k] - 1));
    };
    const auto n = [&](std::size_t k) { return static_cast<std::size_t>(level.cells[k]); };
    cell_[i] = static_cast<std::uint32_t>(level.first_cell + (at(2) * n(1) + at(1)) * n(0) + at(0));
    ++start_[cell_[i]];
    ++count;
  }
  // Ends first: they become the starts while the spheres go in from behind.
  for (std::size_t c = 0, sum = 0; c < start_.size(); ++c) {
    sum += start_[c];
    start_[c] = static_cast<std::uint32_t>(sum);
  }
  for (auto* column : {&x_, &y_, &z_}) column->resize(count + lanes);
  r_.resize(count + lanes);
  places_.resize(count + lanes);
  for (std::size_t i = spheres.size(); i-- > 0;) {
    const SoftSphere& s = spheres[i];
    if (!(s.r > 0)) continue;
    const std::uint32_t slot = --start_[cell_[i]];
    x_[slot] = s.x[0];
    y_[slot] = s.x[1];
    z_[slot] = s.x[2];
    r_[slot] = s.r;
    places_[slot] = static_cast<std::uint32_t>(i);
  }
}

SearchTask RegionCells::task() const {
  return {region_,   scale_of(edges_), skin_,     levels_,   start_.data(),
          x_.data(), y_.data(),        z_.data(), r_.data(), places_.data()};
}

template <class Index>
void FoundNeighbors<Index>::find(const SoftKernels& kernels, const SearchTask& task, std::size_t first,
                                 std::size_t last, std::size_t own, std::uint32_t* room,
                                 std::vector<NeighborList<Index>>& of_place) {
  constexpr std::size_t usual = 16;  // neighbours
  used_ = 0;
  all_.resize(std::max(all_.size(), usual * (last - first)));
  ends_.resize(last - first);
  for (std::size_t slot = first; slot < last; ++slot) {
    const std::uint32_t place = task.places[slot];
    if (place < own) {
      const SoftSphere sphere = {{task.x[slot], task.y[slot], task.z[slot]}, task.r[slot]};
      append(room, static_cast<std::size_t>(kernels.search(task, sphere, place, room) - room));
    }
    ends_[slot - first] = used_;
  }
  // Now that they stay where they are.
  std::size_t begin = 0;
  for (std::size_t slot = first; slot < last; ++slot) {
    const std::size_t end = ends_[slot - first];
    if (task.places[slot] < own)
      of_place[task.places[slot]] = {all_.data() + begin, static_cast<std::uint32_t>(end - begin)};
    begin = end;
  }
}

/// Some more than there are, a fixed number at a time: no branch to mispredict.
template <class Index>
void FoundNeighbors<Index>::append(const std::uint32_t* found, std::size_t count) {
  if (all_.size() < used_ + count + lanes) all_.resize(2 * (used_ + count + lanes));
  Index* const out = all_.data() + used_;
  for (std::size_t k = 0; k < count; k += lanes)
    for (std::size_t l = k; l < k + lanes; ++l) out[l] = static_cast<Index>(found[l]);
  used_ += count;
}

template class FoundNeighbors<std::uint16_t>;
template class FoundNeighbors<std::uint32_t>;

}  // namespace bernal
