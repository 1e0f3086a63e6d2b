#include "soft/soft_blocks.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "core/large_pages.hpp"
#include "core/parallel.hpp"
#include "near/counting_sort.hpp"

namespace bernal {
namespace {

/// Packing fraction of a full block.
constexpr double full = 0.64;
/// The least width of a block, in widths of the halo. With at least one, the halo lies in adjacent blocks
/// only; a narrow block has many more spheres in its halo than of its own.
constexpr double narrowest_block = 2;
/// Empty blocks cost time too.
constexpr double most_blocks_a_sphere = 1.0 / 64;
constexpr std::size_t directions = 27, here = 13;

/// The number of blocks along each axis: even, or one.
std::array<int, 3> blocks_across(double size, std::size_t spheres, const std::array<double, 3>& edges,
                                 const SoftSizes& sizes, float skin) {
  const double volume = size * sizes.volume_a_sphere / full;
  const double least = narrowest_block * 2.0 * (sizes.largest + skin);
  double edge = std::max(std::cbrt(volume), least);
  std::array<int, 3> across{};
  for (;; edge *= 1.2) {
    double count = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const int most = static_cast<int>(std::min(edges[k] / least, 1e4)) & ~1;
      across[k] = std::min(most, 2 * static_cast<int>(std::min(std::round(edges[k] / (2 * edge)), 5e3)));
      if (across[k] < 2) across[k] = 1;
      count *= across[k];
    }
    if (count <= most_blocks_a_sphere * static_cast<double>(spheres) || count == 1) return across;
  }
}

}  // namespace

bool SoftBlocks::suit(std::size_t spheres, const std::array<double, 3>& edges, const SoftSizes& sizes,
                      float skin) {
  const std::array<int, 3> across = blocks_across(usual_size, spheres, edges, sizes, skin);
  return static_cast<double>(spheres) >= fewest_spheres && across[0] * across[1] * across[2] >= fewest_blocks;
}

void SoftBlocks::cut(std::size_t spheres, const std::array<double, 3>& edges, const SoftSizes& sizes,
                     float skin) {
  edges_ = edges;
  sizes_ = sizes;
  skin_ = skin;
  const std::array<int, 3> before = across_;
  across_ = blocks_across(size_, spheres, edges, sizes, skin);
  std::size_t count = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    count *= static_cast<std::size_t>(across_[k]);
    const double width = 2.0 * (sizes.largest + skin) / edges[k] * 0x1p32;
    halo_width_[k] = across_[k] > 1 ? static_cast<std::uint64_t>(std::ceil(1.0001 * width)) : 0;
  }
  blocks_.assign(count, Block{});
  if (visits_.size() != count || across_ != before) order_visits();
}

/// A block waits for its neighbours of earlier colours.
void SoftBlocks::order_visits() {
  const std::size_t nx = static_cast<std::size_t>(across_[0]), ny = static_cast<std::size_t>(across_[1]);
  const auto colour_of = [&](std::size_t b) {
    return (b % nx & 1) | (b / nx % ny & 1) << 1 | (b / nx / ny & 1) << 2;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    std::vector<std::uint32_t> earlier;  // one that two directions lead to stands once
    for (std::size_t d = 0; d < directions; ++d)
      if (const std::size_t other = neighbor_of(b, d); other != b && colour_of(other) < colour_of(b))
        earlier.push_back(static_cast<std::uint32_t>(other));
    std::ranges::sort(earlier);
    const auto repeated = std::ranges::unique(earlier);
    earlier.erase(repeated.begin(), repeated.end());
    for (const std::uint32_t other : earlier) pairs.emplace_back(other, static_cast<std::uint32_t>(b));
  }
  visits_ = Precedence(blocks_.size(), pairs);
}

/// The block in a direction, or this one where none is there.
std::size_t SoftBlocks::neighbor_of(std::size_t b, std::size_t direction) const {
  const std::array<int, 3> step = {static_cast<int>(direction % 3) - 1,
                                   static_cast<int>(direction / 3 % 3) - 1,
                                   static_cast<int>(direction / 9) - 1};
  std::size_t other = 0, before = 1;
  for (std::size_t k = 0, rest = b; k < 3; rest /= static_cast<std::size_t>(across_[k++])) {
    const int n = across_[k];
    if (step[k] != 0 && n == 1) return b;
    other += before * static_cast<std::size_t>(
                          (static_cast<int>(rest % static_cast<std::size_t>(n)) + step[k] + n) % n);
    before *= static_cast<std::size_t>(n);
  }
  return other;
}

/// The region of a block. Its ends agree exactly with the rule that x is in part n · (x / 2^32), rounded
/// down.
SoftRegion SoftBlocks::region_of(std::size_t block) const {
  SoftRegion region;
  for (std::size_t k = 0, b = block; k < 3; b /= static_cast<std::size_t>(across_[k++])) {
    const auto n = static_cast<std::uint64_t>(across_[k]);
    if (n == 1) continue;
    const auto begin = [&](std::uint64_t i) { return ((i << 32) + n - 1) / n; };
    const std::uint64_t i = b % n;
    region.origin[k] = static_cast<std::uint32_t>(begin(i));
    region.extent[k] = begin(i + 1) - begin(i);
  }
  return region;
}

/// Lists the spheres of each block, in their order, without gaps.
void SoftBlocks::sort_into_blocks(const std::vector<SoftSphere>& spheres) {
  const auto block_of = [&](std::size_t p) {
    const SoftSphere& s = spheres[p];
    if (!(s.r > 0)) return blocks_.size();
    std::size_t b = 0;
    for (std::size_t k = 3; k-- > 0;)
      b = b * static_cast<std::size_t>(across_[k]) +
          (std::uint64_t{static_cast<std::uint32_t>(s.x[k])} * static_cast<std::uint64_t>(across_[k]) >> 32);
    return b;
  };
  sort_into_buckets(spheres.size(), blocks_.size(), block_of, order_, start_);
}

bool SoftBlocks::build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
                       std::vector<SoftSphere>& spare, std::size_t count, const std::array<double, 3>& edges,
                       const SoftSizes& sizes, float skin, std::uint32_t movers) {
  cut(count, edges, sizes, skin);
  rows_.clear();
  halos_.clear();
  groups_.clear();
  sort_into_blocks(spheres);
  if (!find_orders(spheres, ids, movers)) return false;

  const std::size_t places = blocks_.back().first_place + blocks_.back().places;
  resize_anew(spare, places);
  resize_anew(spare_ids_, places);
  parallel_for(blocks_.size(), [&](std::size_t b) {
    const std::vector<std::uint16_t>& from = drafts_[b].from;
    for (std::size_t q = 0; q < from.size(); ++q) {
      const bool is_gap = from[q] == gap;
      const std::size_t p = is_gap ? 0 : order_[start_[b] + from[q]];
      spare[blocks_[b].first_place + q] = is_gap ? no_sphere : spheres[p];
      spare_ids_[blocks_[b].first_place + q] = is_gap ? nobody : ids[p];
    }
    find_exports(b, spare, scratch_.local());
  });
  spheres.swap(spare);
  ids.swap(spare_ids_);

  std::atomic<bool> fits = true;
  parallel_for(blocks_.size(), [&](std::size_t b) {
    if (!find_neighbors(b, spheres, scratch_.local())) fits = false;
  });
  return fits;
}

/// The order within each block; resting spheres come last. Returns whether no block has too many places.
bool SoftBlocks::find_orders(const std::vector<SoftSphere>& spheres, const std::vector<std::uint32_t>& ids,
                             std::uint32_t movers) {
  drafts_.resize(blocks_.size());
  std::atomic<bool> fit = true;
  parallel_for(blocks_.size(), [&](std::size_t b) {
    if (start_[b + 1] - start_[b] >= most_places) fit = false;
    if (!fit) return;
    Scratch& mine = scratch_.local();
    mine.spheres.clear();
    mine.moving.clear();
    mine.resting.clear();
    for (std::size_t n = 0; n < start_[b + 1] - start_[b]; ++n) {
      const std::uint32_t p = order_[start_[b] + n];
      const bool rests = ids[p] >= movers;
      (rests ? mine.resting : mine.moving).push_back(static_cast<std::uint16_t>(n));
      if (!rests) mine.spheres.push_back(spheres[p]);
    }
    mine.order.find(mine.spheres, region_of(b), edges_, sizes_, skin_, false);
    std::vector<std::uint16_t>& from = drafts_[b].from;
    from.clear();
    for (const std::uint32_t k : mine.order.sphere_at()) from.push_back(k == nobody ? gap : mine.moving[k]);
    blocks_[b].swept = from.size();
    from.insert(from.end(), mine.resting.begin(), mine.resting.end());
    from.resize((from.size() + lanes - 1) / lanes * lanes, gap);
    blocks_[b].places = from.size();
    if (blocks_[b].places >= most_places) fit = false;
  });
  std::size_t places = 0;
  for (Block& block : blocks_) {
    block.first_place = places;
    places += block.places;
  }
  return fit;
}

/// A direction is -1, 0 or 1 along each axis, the first axis the fastest.
void SoftBlocks::find_exports(std::size_t block, const std::vector<SoftSphere>& spheres, Scratch& scratch) {
  const SoftRegion region = region_of(block);
  const Block& mine = blocks_[block];
  Draft& draft = drafts_[block];
  auto& by_direction = scratch.exports;
  for (auto& places : by_direction) places.clear();
  for (std::size_t q = 0; q < mine.places; ++q) {
    const SoftSphere& s = spheres[mine.first_place + q];
    if (!(s.r > 0)) continue;
    std::array<int, 3> low{}, high{};
    bool is_export = false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (region.wraps(k)) continue;
      const std::uint64_t at = region.offset(s, k);
      low[k] = at < halo_width_[k] ? -1 : 0;
      high[k] = at + halo_width_[k] >= region.extent[k] ? 1 : 0;
      is_export |= low[k] != high[k];
    }
    if (!is_export) continue;
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          by_direction[static_cast<std::size_t>(13 + x + 3 * y + 9 * z)].push_back(
              static_cast<std::uint16_t>(q));
  }
  by_direction[here].clear();
  draft.exports.clear();
  for (std::size_t d = 0; d < directions; ++d) {
    draft.export_start[d] = static_cast<std::uint32_t>(draft.exports.size());
    draft.exports.insert(draft.exports.end(), by_direction[d].begin(), by_direction[d].end());
  }
  draft.export_start[directions] = static_cast<std::uint32_t>(draft.exports.size());
}

bool SoftBlocks::find_neighbors(std::size_t b, const std::vector<SoftSphere>& spheres, Scratch& scratch) {
  Block& block = blocks_[b];
  const auto begin = spheres.begin() + static_cast<std::ptrdiff_t>(block.first_place);
  scratch.spheres.assign(begin, begin + static_cast<std::ptrdiff_t>(block.places));
  scratch.halo.clear();
  for (std::size_t d = 0; d < directions; ++d) {
    const std::size_t other = neighbor_of(b, d);
    if (other == b) continue;
    const Draft& draft = drafts_[other];
    const std::size_t back = directions - 1 - d;
    for (std::uint32_t e = draft.export_start[back]; e < draft.export_start[back + 1]; ++e)
      scratch.halo.push_back(static_cast<std::uint32_t>(blocks_[other].first_place + draft.exports[e]));
  }
  if (block.places + scratch.halo.size() >= most_places) return false;
  for (const std::uint32_t p : scratch.halo) scratch.spheres.push_back(spheres[p]);

  SoftRegion around = region_of(b);
  for (std::size_t k = 0; k < 3; ++k) {
    if (around.wraps(k)) continue;
    around.origin[k] -= static_cast<std::uint32_t>(halo_width_[k]);
    around.extent[k] += 2 * halo_width_[k];
  }
  scratch.cells.sort(scratch.spheres, around, edges_, sizes_, skin_);
  scratch.lists.assign(block.swept, {});
  scratch.room.reserve(most_places);
  scratch.found.find(kernels_, scratch.cells.task(), 0, scratch.cells.size(), block.swept, scratch.room,
                     scratch.lists);
  name_neighbors(block.places, scratch);
  const auto name_of = [&](std::uint32_t p) { return scratch.name_of[p]; };
  scratch.rows.clear();
  scratch.groups.resize(block.swept / lanes);
  for (std::size_t g = 0; g < scratch.groups.size(); ++g)
    scratch.groups[g].rows = append_rows(&scratch.lists[g * lanes], g * lanes, name_of, scratch.rows);

  const std::uint16_t* row = rows_.keep(scratch.rows);
  for (NeighborRows<std::uint16_t>& group : scratch.groups) {
    group.first = row;
    row += lanes * group.rows;
  }
  block.groups = groups_.keep(scratch.groups);
  block.halo = halos_.keep(scratch.halo);
  block.halo_size = static_cast<std::uint32_t>(scratch.halo.size());
  return true;
}

/// Removes spheres that are nobody's neighbours from the halo: a third of equal spheres, and most of them if
/// a few large spheres make it wide. `name_of` becomes the place in a visit of each sphere that remains.
void SoftBlocks::name_neighbors(std::size_t own, Scratch& scratch) {
  std::vector<std::uint16_t>& name_of = scratch.name_of;
  name_of.assign(scratch.spheres.size(), 0);
  for (const std::uint32_t p : scratch.found.all()) name_of[p] = 1;
  std::size_t kept = own;
  for (std::size_t h = 0; h < scratch.halo.size(); ++h) {
    if (name_of[own + h] == 0) continue;
    name_of[own + h] = static_cast<std::uint16_t>(kept);
    scratch.halo[kept++ - own] = scratch.halo[h];
  }
  scratch.halo.resize(kept - own);
  for (std::size_t p = 0; p < own; ++p) name_of[p] = static_cast<std::uint16_t>(p);
}

float SoftBlocks::visit(const Block& block, const SweepTask& task) const {
  if (block.swept == 0) return 0;
  thread_local std::vector<SoftSphere> here_and_around;
  const std::size_t size = block.places + block.halo_size;
  if (here_and_around.size() < size) here_and_around.resize(size + size / 4);
  SoftSphere* const spheres = here_and_around.data();
  SoftSphere* const own = task.spheres + block.first_place;
  std::memcpy(spheres, own, block.places * sizeof(SoftSphere));
  for (std::uint32_t h = 0; h < block.halo_size; ++h) spheres[block.places + h] = task.spheres[block.halo[h]];
  SweepTask here_task = task;
  here_task.spheres = spheres;
  here_task.first_group = block.first_place / lanes;
  const std::size_t last = here_task.first_group + block.swept / lanes;
  const float largest = kernels_.sweep_short(here_task, block.groups, here_task.first_group, last);
  std::memcpy(own, spheres, block.places * sizeof(SoftSphere));
  return largest;
}

float SoftBlocks::sweep(const SweepTask& task) const {
  std::vector<float> largest(blocks_.size(), 0.0f);
  parallel_by_precedence(visits_, [&](std::size_t b) { largest[b] = visit(blocks_[b], task); });
  return *std::ranges::max_element(largest);
}

std::size_t SoftBlocks::bytes_a_sweep() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_) {
    bytes += 2 * block.places * sizeof(SoftSphere);
    bytes += block.halo_size * (sizeof(SoftSphere) + sizeof(std::uint32_t));
    for (std::size_t g = 0; g < block.swept / lanes; ++g)
      bytes += sizeof(block.groups[g]) + lanes * block.groups[g].rows * sizeof(std::uint16_t);
  }
  return bytes;
}

}  // namespace bernal
