#include "soft/soft_lists.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr std::size_t groups_per_block = 64, spheres_a_piece = 4096;

}  // namespace

void SoftLists::build(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& ids,
                      const std::array<double, 3>& edges, const SoftSizes& sizes, float skin,
                      std::uint32_t movers) {
  const bool in_threads = spheres.size() >= worth_threads;
  spheres.swap(before_.spheres);
  ids.swap(before_.ids);
  take_resting_out(movers);
  order_.find(before_.spheres, SoftRegion{}, edges, sizes, skin, by_octaves_, in_threads);
  const std::vector<std::uint32_t>& sphere_at = order_.sphere_at();
  spheres.resize(sphere_at.size());
  ids.resize(sphere_at.size());
  const auto put_in_order = [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const std::uint32_t i = sphere_at[p];
      spheres[p] = i == nobody ? no_sphere : before_.spheres[i];
      ids[p] = i == nobody ? nobody : before_.ids[i];
    }
  };
  parallel_ranges_if(in_threads, sphere_at.size(), spheres_a_piece, put_in_order);
  spheres.insert(spheres.end(), resting_.spheres.begin(), resting_.spheres.end());
  ids.insert(ids.end(), resting_.ids.begin(), resting_.ids.end());
  cells_.sort(spheres, SoftRegion{}, edges, sizes, skin, in_threads);
  find_neighbors(sphere_at.size());
}

/// Of those that are to be sorted: they leave gaps.
void SoftLists::take_resting_out(std::uint32_t movers) {
  resting_.spheres.clear();
  resting_.ids.clear();
  if (movers == nobody) return;
  for (std::size_t p = 0; p < before_.spheres.size(); ++p) {
    if (!(before_.spheres[p].r > 0) || before_.ids[p] < movers) continue;
    resting_.spheres.push_back(std::exchange(before_.spheres[p], no_sphere));
    resting_.ids.push_back(before_.ids[p]);
  }
}

void SoftLists::find_neighbors(std::size_t swept) {
  const SearchTask task = cells_.task();
  const std::size_t slots = cells_.size(), groups = swept / lanes;
  found_of_.assign(swept, {});
  found_.resize((slots + spheres_a_piece - 1) / spheres_a_piece);
  tbb::parallel_for(std::size_t{0}, found_.size(), [&](std::size_t n) {
    const std::size_t first = n * spheres_a_piece, last = std::min(slots, first + spheres_a_piece);
    CandidateRoom& room = rooms_.local();
    room.reserve(slots);
    found_[n].find(kernels_, task, first, last, swept, room, found_of_);
  });

  groups_.resize(groups);
  rows_.resize((groups + groups_per_block - 1) / groups_per_block);
  tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t block) {
    const std::size_t first = block * groups_per_block, last = std::min(groups, first + groups_per_block);
    std::vector<std::uint32_t>& rows = rows_[block];
    rows.clear();
    for (std::size_t g = first; g < last; ++g)
      groups_[g].rows = append_rows(&found_of_[g * lanes], g * lanes, std::identity{}, rows);
    const std::uint32_t* begin = rows.data();
    for (std::size_t g = first; g < last; begin += lanes * groups_[g++].rows) groups_[g].first = begin;
  });
}

float SoftLists::sweep(const SweepTask& task, bool in_threads) const {
  std::vector<float> largest(groups_.size() + 1, 0.0f);
  for (const std::vector<Chain>& chains : order_.phases()) {
    const auto sweep = [&](std::size_t c) {
      largest[chains[c].first] = kernels_.sweep(task, groups_.data(), chains[c].first, chains[c].last);
    };
    if (!in_threads || chains.size() == 1) {
      for (std::size_t c = 0; c < chains.size(); ++c) sweep(c);
    } else {
      tbb::parallel_for(std::size_t{0}, chains.size(), sweep);
    }
  }
  return *std::ranges::max_element(largest);
}

}  // namespace bernal
