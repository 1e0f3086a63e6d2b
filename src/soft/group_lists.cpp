#include "soft/group_lists.hpp"

#include <cmath>

namespace bernal {
namespace {

/// The most cells for each sphere of a level.
constexpr double cells_per_sphere = 2;
/// The widths of a cell, over the largest distance of neighbours of its level. A search reads the cells along
/// the first axis as one run, `lanes` spheres at a time: so runs are few, and not much too long.
constexpr std::array<double, 3> cell_widths = {0.5, 1, 1};

std::size_t level_of(float r, const SoftSizes& sizes) {
  std::size_t l = 0;
  for (float half = sizes.largest / 2; r <= half && l + 1 < sizes.levels; half /= 2) ++l;
  return l;
}

}  // namespace

/// Returns the number of cells of all levels.
std::size_t RegionCells::choose_levels(std::span<const SoftSphere> spheres, const SoftSizes& sizes) {
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
  return cells;
}

void RegionCells::sort(std::span<const SoftSphere> spheres, const SoftRegion& region,
                       const std::array<double, 3>& edges, const SoftSizes& sizes, float skin,
                       bool in_threads) {
  region_ = region;
  edges_ = edges;
  skin_ = skin;
  const std::size_t cells = choose_levels(spheres, sizes);
  const auto cell_of = [&](std::size_t i) {
    const SoftSphere& s = spheres[i];
    if (!(s.r > 0)) return cells;
    const SoftLevel& level = levels_[sizes.levels == 1 ? 0 : level_of(s.r, sizes)];
    const auto at = [&](std::size_t k) {
      const int cell = static_cast<int>(region.offset(s, k) * level.cells_a_unit[k]);
      return static_cast<std::size_t>(std::min(cell, level.cells[k] - 1));
    };
    const auto n = [&](std::size_t k) { return static_cast<std::size_t>(level.cells[k]); };
    return level.first_cell + (at(2) * n(1) + at(1)) * n(0) + at(0);
  };
  for (auto* column : {&x_, &y_, &z_}) column->resize(spheres.size() + lanes);
  r_.resize(spheres.size() + lanes);
  places_.resize(spheres.size() + lanes);
  const auto put = [&](std::uint32_t slot, std::size_t i) {
    const SoftSphere& s = spheres[i];
    x_[slot] = s.x[0];
    y_[slot] = s.x[1];
    z_[slot] = s.x[2];
    r_[slot] = s.r;
    places_[slot] = static_cast<std::uint32_t>(i);
  };
  put_into_buckets(spheres.size(), cells, cell_of, put, start_, room_, in_threads);
}

SearchTask RegionCells::task() const {
  return {region_,   scale_of(edges_), skin_,     levels_,   start_.data(),
          x_.data(), y_.data(),        z_.data(), r_.data(), places_.data()};
}

namespace {

SoftSphere sphere_in(const SearchTask& task, std::size_t slot) {
  return {{task.x[slot], task.y[slot], task.z[slot]}, task.r[slot]};
}

/// Cuts slots into parts that share their candidates: few spheres, so close together that all of them have
/// hardly more candidates than one has.
class PartsOfSlots {
 public:
  explicit PartsOfSlots(const SearchTask& task) : task_(task) {
    const double least_reach = 2.0 * (task.levels.back().largest + task.skin);
    const double most_reach = 2.0 * (task.levels.front().largest + task.skin);
    for (std::size_t k = 0; k < 3; ++k) {
      const double widest = std::min(least_reach, 0.5 * 0x1p32 * task.scale[k] - most_reach);
      widest_[k] = static_cast<std::uint32_t>(std::max(0.0, widest / task.scale[k]));
    }
  }

  /// The next part, from a slot on; returns where it ends.
  std::size_t take(std::size_t first, std::size_t last, SearchPart& part) const {
    part.origin = sphere_in(task_, first);
    std::array<std::uint32_t, 3> low{}, high{};
    for (std::size_t k = 0; k < 3; ++k) low[k] = high[k] = task_.region.offset(part.origin, k);
    float largest = part.origin.r;
    std::size_t end = first + 1;
    for (; end < std::min(last, first + most); ++end) {
      const SoftSphere next = sphere_in(task_, end);
      std::array<std::uint32_t, 3> lower{}, higher{};
      bool is_close = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t at = task_.region.offset(next, k);
        lower[k] = std::min(low[k], at);
        higher[k] = std::max(high[k], at);
        is_close &= higher[k] - lower[k] <= widest_[k];
      }
      if (!is_close) break;
      low = lower;
      high = higher;
      largest = std::max(largest, next.r);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      part.low[k] = low[k];
      part.high[k] = high[k];
    }
    part.reach = largest + 2 * task_.skin;
    return end;
  }

 private:
  static constexpr std::size_t most = 6;

  const SearchTask& task_;
  std::array<std::uint32_t, 3> widest_;
};

}  // namespace

void FoundNeighbors::find(const SoftKernels& kernels, const SearchTask& task, std::size_t first,
                          std::size_t last, std::size_t own, CandidateRoom& room,
                          std::vector<NeighborList>& of_place) {
  constexpr std::size_t usual = 16;  // neighbours
  used_ = 0;
  all_.resize(std::max(all_.size(), usual * (last - first)));
  ends_.resize(last - first);
  const PartsOfSlots parts(task);
  const Candidates candidates = room.candidates();
  SearchPart part{};
  for (std::size_t slot = first; slot < last;) {
    if (task.places[slot] >= own) {
      ends_[slot++ - first] = used_;
      continue;
    }
    const std::size_t end_of_part = parts.take(slot, last, part);
    const std::size_t count = kernels.gather(task, part, candidates);
    const std::size_t most = (end_of_part - slot) * count + lanes;
    if (all_.size() < used_ + most) all_.resize(2 * (used_ + most));
    for (; slot < end_of_part; ++slot) {
      const std::uint32_t place = task.places[slot];
      if (place < own) {
        std::uint32_t* const found = all_.data() + used_;
        used_ += static_cast<std::size_t>(
            kernels.search(task, part, candidates, count, sphere_in(task, slot), place, found) - found);
      }
      ends_[slot - first] = used_;
    }
  }
  // Only now, when `all_` is no longer moved.
  std::size_t begin = 0;
  for (std::size_t slot = first; slot < last; ++slot) {
    const std::size_t end = ends_[slot - first];
    if (task.places[slot] < own)
      of_place[task.places[slot]] = {all_.data() + begin, static_cast<std::uint32_t>(end - begin)};
    begin = end;
  }
}

}  // namespace bernal
