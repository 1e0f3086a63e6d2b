#include "soft/group_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bernal {
namespace {

/// Cells for each sphere of a level, at most.
constexpr double cells_per_sphere = 2;

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
        level.cells[k] = std::max(1, static_cast<int>(std::min(length / width, 1e6)));
      }
      count = static_cast<double>(level.cells[0]) * level.cells[1] * level.cells[2];
      width *= 1.1;
    } while (count > cells_per_sphere * static_cast<double>(level.spheres) + 27);
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
  std::vector<std::array<double, 3>> cells_a_unit(levels_.size());
  for (std::size_t l = 0; l < levels_.size(); ++l)
    for (std::size_t k = 0; k < 3; ++k)
      cells_a_unit[l][k] = levels_[l].cells[k] / static_cast<double>(region.extent[k]);
  std::size_t count = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const SoftSphere& s = spheres[i];
    if (!(s.r > 0)) continue;
    const std::size_t l = sizes.levels == 1 ? 0 : level_of(s.r, sizes);
    const SoftLevel& level = levels_[l];
    const auto at = [&](std::size_t k) {
      const int cell = static_cast<int>(region.offset(s, k) * cells_a_unit[l][k]);
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
  return {region_,   edges_,    scale_of(edges_), skin_,     levels_,       start_.data(),
          x_.data(), y_.data(), z_.data(),        r_.data(), places_.data()};
}

template <class Index>
std::uint32_t FoundNeighbors::append(const SoftKernels& kernels, const SearchTask& task,
                                     const SoftSphere* group, std::uint32_t first, Index filler,
                                     std::vector<Index>& rows) {
  std::array<std::size_t, lanes> count{};
  std::size_t most = 0;
  for (std::size_t l = 0; l < lanes; ++l) {
    if (!(group[l].r > 0)) continue;
    std::uint32_t* const out = found_[l].get();
    const auto self = static_cast<std::uint32_t>(first + l);
    count[l] = static_cast<std::size_t>(kernels.search(task, group[l], self, out) - out);
    most = std::max(most, count[l]);
  }
  const std::size_t begin = rows.size();
  rows.resize(begin + most * lanes, filler);
  Index* const row = rows.data() + begin;
  for (std::size_t l = 0; l < lanes; ++l)
    for (std::size_t k = 0; k < count[l]; ++k) row[k * lanes + l] = static_cast<Index>(found_[l][k]);
  return static_cast<std::uint32_t>(most);
}

template std::uint32_t FoundNeighbors::append(const SoftKernels&, const SearchTask&, const SoftSphere*,
                                              std::uint32_t, std::uint32_t, std::vector<std::uint32_t>&);
template std::uint32_t FoundNeighbors::append(const SoftKernels&, const SearchTask&, const SoftSphere*,
                                              std::uint32_t, std::uint16_t, std::vector<std::uint16_t>&);

}  // namespace bernal
