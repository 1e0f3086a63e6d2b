#include "soft/soft_lists.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "neighbors/counting_sort.hpp"

namespace bernal {
namespace {

constexpr std::uint32_t nobody = 0xFFFFFFFF;
constexpr SoftSphere gap = {{0, 0, 0}, std::numeric_limits<float>::quiet_NaN()};
/// The share of the spheres, the largest, that is swept alone if the others are smaller.
constexpr double share_of_large = 0.01;
/// Where no more than this share of the spheres is smaller than a level, they join it: a level costs a search
/// for every sphere.
constexpr double share_of_level = 0.6;
constexpr std::size_t most_levels = 24;
/// Cells for each sphere of a level, at most.
constexpr double cells_per_sphere = 2;
constexpr std::size_t pencils_per_chain = 32;
constexpr std::size_t groups_per_block = 64;
/// Spheres whose radii differ by less than this part of an octave are alike.
constexpr double classes_per_octave = 4;
constexpr std::size_t most_classes = 64;

/// The cell of `cells` on an axis.
int cell_of(std::int32_t x, int cells) {
  return static_cast<int>(
      (std::uint64_t{static_cast<std::uint32_t>(x)} * static_cast<std::uint64_t>(cells)) >> 32);
}

int count_of_cells(double edge, double width) {
  return std::max(1, static_cast<int>(std::min(edge / width, 1e6)));
}

/// Reorders `order` by key(i) < buckets, keeping the order of equals. Returns where each bucket starts.
template <class Key>
std::vector<std::uint32_t> sort_by(std::vector<std::uint32_t>& order, std::size_t buckets, const Key& key) {
  std::vector<std::uint32_t> start, sorted(order.size()), place(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) place[n] = static_cast<std::uint32_t>(key(order[n]));
  counting_sort(place, buckets, start);
  for (std::size_t n = 0; n < order.size(); ++n) sorted[place[n]] = order[n];
  order.swap(sorted);
  return start;
}

/// The spheres of one pencil that have not been given a turn yet.
struct Pencil {
  std::uint32_t next, end;
};

/// The neighbours of the spheres of a group, with room for as many as there may be: memory that is never
/// touched costs nothing.
using FoundNeighbors = std::array<std::unique_ptr<std::uint32_t[]>, lanes>;

}  // namespace

SoftLists::SoftLists(const std::vector<float>& radii, float skin, const SoftKernels& kernels, bool by_octaves)
    : kernels_(kernels), skin_(skin), by_octaves_(by_octaves) {
  std::vector<float> ascending = radii;
  const auto nth = ascending.begin() + static_cast<std::ptrdiff_t>((1 - share_of_large) *
                                                                   static_cast<double>(ascending.size() - 1));
  std::nth_element(ascending.begin(), nth, ascending.end());
  large_ = *nth;
  const auto [least, most] = std::ranges::minmax(radii);
  largest_ = most;
  equal_ = least == most;
  level_count_ = 1;
  const auto worth_a_level = [&](float r) {
    const auto smaller = std::ranges::count_if(radii, [r](float other) { return other <= r; });
    return static_cast<double>(smaller) > share_of_level * static_cast<double>(radii.size());
  };
  for (float r = most / 2; worth_a_level(r) && level_count_ < most_levels; r /= 2) ++level_count_;
}

void SoftLists::sort_into_cells(const std::vector<SoftSphere>& compact, const std::array<double, 3>& edges) {
  std::vector<std::uint8_t> level_of(compact.size());
  levels_.assign(level_count_, SoftLevel{});
  for (std::size_t i = 0; i < compact.size(); ++i) {
    std::uint8_t l = 0;
    for (float r = largest_ / 2; compact[i].r <= r && l + 1u < level_count_; r /= 2) ++l;
    level_of[i] = l;
    ++levels_[l].spheres;
  }
  std::size_t cells = 0;
  for (std::size_t l = 0; l < level_count_; ++l) {
    SoftLevel& level = levels_[l];
    level.largest = std::ldexp(largest_, -static_cast<int>(l));
    level.first_cell = cells;
    double width = 2.0 * (level.largest + skin_), count = 0;
    do {
      for (std::size_t k = 0; k < 3; ++k) level.cells[k] = count_of_cells(edges[k], width);
      count = static_cast<double>(level.cells[0]) * level.cells[1] * level.cells[2];
      width *= 1.1;
    } while (count > cells_per_sphere * static_cast<double>(level.spheres) + 27);
    cells += static_cast<std::size_t>(count);
  }

  std::vector<std::uint32_t> order(compact.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  start_ = sort_by(order, cells, [&](std::uint32_t i) {
    const SoftLevel& level = levels_[level_of[i]];
    const auto at = [&](std::size_t k) {
      return static_cast<std::size_t>(cell_of(compact[i].x[k], level.cells[k]));
    };
    const auto n = [&](std::size_t k) { return static_cast<std::size_t>(level.cells[k]); };
    return level.first_cell + (at(2) * n(1) + at(1)) * n(0) + at(0);
  });
  slot_.resize(compact.size());
  sorted_.assign(compact.size() + lanes, gap);
  for (std::uint32_t s = 0; s < order.size(); ++s) {
    slot_[order[s]] = s;
    sorted_[s] = compact[order[s]];
  }
}

/// For every place which of the spheres has it, or nobody.
std::vector<SoftLists::Place> SoftLists::sweep_order(const std::vector<SoftSphere>& compact,
                                                     const std::array<double, 3>& edges) {
  const int along = std::min(static_cast<int>(compact.size()) + 1, count_of_cells(edges[0], 2.0 * large_));
  std::vector<std::uint32_t> order(compact.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  sort_by(order, static_cast<std::size_t>(along),
          [&](std::uint32_t i) { return cell_of(compact[i].x[0], along); });
  if (!equal_)
    sort_by(order, most_classes, [&](std::uint32_t i) {
      const double octaves = std::log2(largest_ / compact[i].r);
      return std::min(most_classes - 1, static_cast<std::size_t>(classes_per_octave * octaves));
    });

  phases_.clear();
  std::vector<Place> sphere_at;
  sphere_at.reserve(compact.size() + compact.size() / 8);
  if (!by_octaves_) {
    add_pencils(std::move(order), large_, compact, edges, sphere_at);
    return sphere_at;
  }
  // The large ones come last: they are moved by what has given way to them.
  std::array<std::vector<std::uint32_t>, most_levels> octaves;
  for (const std::uint32_t i : order) {
    std::size_t k = 0;
    for (float r = largest_ / 2; compact[i].r <= r && k + 1 < octaves.size(); r /= 2) ++k;
    octaves[k].push_back(i);
  }
  for (std::size_t k = octaves.size(); k-- > 0;)
    if (!octaves[k].empty())
      add_pencils(std::move(octaves[k]), std::ldexp(largest_, -static_cast<int>(k)), compact, edges,
                  sphere_at);
  return sphere_at;
}

/// Places for the spheres of `order` behind those that there are: in pencils, but for those larger than
/// `largest`, which come alone.
void SoftLists::add_pencils(std::vector<std::uint32_t> order, float largest,
                            const std::vector<SoftSphere>& compact, const std::array<double, 3>& edges,
                            std::vector<Place>& sphere_at) {
  const double width = 2.0 * (largest + skin_);
  // Few spheres in much room do not need more pencils than there are spheres.
  const int most_across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(order.size()))));
  const auto pencils_across = [&](double edge) {
    const int count = std::min(most_across, count_of_cells(edge, width));
    return count > 1 ? count & ~1 : 1;
  };
  const int across_y = pencils_across(edges[1]), across_z = pencils_across(edges[2]);
  const auto pencils = static_cast<std::size_t>(across_y) * static_cast<std::size_t>(across_z);
  const std::vector<std::uint32_t> start = sort_by(order, pencils + 1, [&](std::uint32_t i) {
    if (compact[i].r > largest) return pencils;
    return static_cast<std::size_t>(cell_of(compact[i].x[2], across_z)) * static_cast<std::size_t>(across_y) +
           static_cast<std::size_t>(cell_of(compact[i].x[1], across_y));
  });

  const auto fill_group = [&] { sphere_at.resize((sphere_at.size() + lanes - 1) / lanes * lanes, nobody); };
  const auto add_chain = [&](std::vector<Pencil> live) {
    const std::size_t first = sphere_at.size() / lanes;
    std::erase_if(live, [](const Pencil& p) { return p.next == p.end; });
    while (!live.empty()) {
      // A turn for every pencil; no pencil twice within a group.
      if (live.size() < lanes) fill_group();
      for (Pencil& p : live) sphere_at.push_back(order[p.next++]);
      std::erase_if(live, [](const Pencil& p) { return p.next == p.end; });
    }
    fill_group();
    if (sphere_at.size() / lanes > first) phases_.back().push_back({first, sphere_at.size() / lanes});
  };

  for (int colour = 0; colour < 4; ++colour) {
    std::vector<Pencil> all;
    for (int z = colour / 2; z < across_z; z += 2) {
      for (int y = colour % 2; y < across_y; y += 2) {
        const auto p =
            static_cast<std::size_t>(z) * static_cast<std::size_t>(across_y) + static_cast<std::size_t>(y);
        all.push_back({start[p], start[p + 1]});
      }
    }
    const std::size_t chains = std::max<std::size_t>(1, all.size() / pencils_per_chain);
    phases_.emplace_back();
    for (std::size_t c = 0; c < chains; ++c) {
      const auto part = [&](std::size_t n) {
        return all.begin() + static_cast<std::ptrdiff_t>(all.size() * n / chains);
      };
      add_chain({part(c), part(c + 1)});
    }
  }
  phases_.emplace_back();
  add_chain({{start[pencils], start[pencils + 1]}});
  std::erase_if(phases_, [](const auto& chains) { return chains.empty(); });
}

void SoftLists::find_neighbors(const std::vector<SoftSphere>& spheres, const std::array<double, 3>& edges) {
  const SearchTask task{edges,         scale_of(edges), skin_,         levels_,
                        start_.data(), sorted_.data(),  places_.data()};
  const std::size_t groups = spheres.size() / lanes;
  const auto filler = static_cast<std::uint32_t>(groups * lanes);  // the gap behind the last group
  groups_.resize(groups);
  rows_.resize((groups + groups_per_block - 1) / groups_per_block);

  tbb::enumerable_thread_specific<FoundNeighbors> of_thread([&] {
    FoundNeighbors found;
    for (auto& lane : found) lane.reset(new std::uint32_t[sorted_.size() + lanes]);
    return found;
  });
  tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t block) {
    FoundNeighbors& found = of_thread.local();
    const std::size_t first = block * groups_per_block, last = std::min(groups, first + groups_per_block);
    std::vector<std::uint32_t>& rows = rows_[block];
    rows.clear();
    std::array<std::size_t, groups_per_block> begin;
    for (std::size_t g = first; g < last; ++g) {
      std::array<std::size_t, lanes> count{};
      for (std::size_t l = 0; l < lanes; ++l) {
        const SoftSphere& me = spheres[g * lanes + l];
        if (!(me.r > 0)) continue;
        const auto self = static_cast<std::uint32_t>(g * lanes + l);
        count[l] = static_cast<std::size_t>(kernels_.search(task, me, self, found[l].get()) - found[l].get());
      }
      const std::size_t most = *std::ranges::max_element(count);
      begin[g - first] = rows.size();
      groups_[g].rows = static_cast<std::uint32_t>(most);
      rows.resize(rows.size() + most * lanes, filler);
      std::uint32_t* row = rows.data() + begin[g - first];
      for (std::size_t l = 0; l < lanes; ++l)
        for (std::size_t k = 0; k < count[l]; ++k) row[k * lanes + l] = found[l].get()[k];
    }
    for (std::size_t g = first; g < last; ++g) groups_[g].first = rows.data() + begin[g - first];
  });
}

void SoftLists::build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
                      const std::array<double, 3>& edges) {
  std::vector<SoftSphere> compact;
  std::vector<std::uint32_t> compact_ids;
  compact.reserve(spheres.size());
  compact_ids.reserve(spheres.size());
  for (std::size_t p = 0; p < spheres.size(); ++p) {
    if (!(spheres[p].r > 0)) continue;
    compact.push_back(spheres[p]);
    compact_ids.push_back(ids[p]);
  }
  sort_into_cells(compact, edges);
  const std::vector<Place> sphere_at = sweep_order(compact, edges);

  spheres.assign(sphere_at.size() + 1, gap);
  ids.assign(sphere_at.size() + 1, nobody);
  places_.assign(sorted_.size(), 0);
  for (Place p = 0; p < sphere_at.size(); ++p) {
    const std::uint32_t i = sphere_at[p];
    if (i == nobody) continue;
    spheres[p] = compact[i];
    ids[p] = compact_ids[i];
    places_[slot_[i]] = p;
  }
  find_neighbors(spheres, edges);
}

}  // namespace bernal
