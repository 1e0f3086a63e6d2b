#include "soft/sweep_order.hpp"

#include <algorithm>
#include <cmath>

#include "neighbors/counting_sort.hpp"

namespace bernal {
namespace {

/// The share of the spheres, the largest, that is swept alone if the others are smaller.
constexpr double share_of_large = 0.01;
/// Where no more than this share of the spheres is smaller than a level, they join it: a level costs a search
/// for every sphere.
constexpr double share_of_level = 0.6;
constexpr std::size_t most_levels = 24;
constexpr std::size_t pencils_per_chain = 32;
/// Spheres whose radii differ by less than this part of an octave are alike.
constexpr double classes_per_octave = 4;
constexpr std::size_t most_classes = 64;

int count_of_parts(double length, double width) {
  return std::max(1, static_cast<int>(std::min(length / width, 1e6)));
}

}  // namespace

SoftSizes::SoftSizes(const std::vector<float>& radii) {
  std::vector<float> ascending = radii;
  const auto nth = ascending.begin() + static_cast<std::ptrdiff_t>((1 - share_of_large) *
                                                                   static_cast<double>(ascending.size() - 1));
  std::nth_element(ascending.begin(), nth, ascending.end());
  large = *nth;
  const auto [least, most] = std::ranges::minmax(radii);
  largest = most;
  equal = least == most;
  const auto worth_a_level = [&](float r) {
    const auto smaller = std::ranges::count_if(radii, [r](float other) { return other <= r; });
    return static_cast<double>(smaller) > share_of_level * static_cast<double>(radii.size());
  };
  for (float r = most / 2; worth_a_level(r) && levels < most_levels; r /= 2) ++levels;
  for (const float r : radii) volume_a_sphere += double{r} * r * r;
  volume_a_sphere *= 4.18879020478639 / static_cast<double>(radii.size());
}

void SweepOrder::find(std::span<const SoftSphere> spheres, const SoftRegion& region,
                      const std::array<double, 3>& edges, const SoftSizes& sizes, float skin,
                      bool by_octaves) {
  spheres_ = spheres;
  region_ = region;
  edges_ = edges;
  skin_ = skin;
  phases_.clear();
  sphere_at_.clear();
  sphere_at_.reserve(spheres.size() + spheres.size() / 8);

  // Along the axis, and in classes where there are sizes: one key for both.
  const double length = edges[0] * static_cast<double>(region.extent[0]) * 0x1p-32;
  const int along = std::min(static_cast<int>(spheres.size()) + 1, count_of_parts(length, 2.0 * sizes.large));
  place_.resize(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    std::size_t key = static_cast<std::size_t>(region.part(spheres[i], 0, along));
    if (!sizes.equal) {
      const double octaves = std::log2(sizes.largest / spheres[i].r);
      key += static_cast<std::size_t>(along) *
             std::min(most_classes - 1, static_cast<std::size_t>(classes_per_octave * octaves));
    }
    place_[i] = static_cast<std::uint32_t>(key);
  }
  counting_sort(place_, static_cast<std::size_t>(along) * (sizes.equal ? 1 : most_classes), start_);
  order_.resize(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) order_[place_[i]] = static_cast<std::uint32_t>(i);

  if (!by_octaves) {
    add_pencils(order_, sizes.large);
    return;
  }
  // The large ones come last: they are moved by what has given way to them.
  std::array<std::vector<std::uint32_t>, most_levels> octaves;
  for (const std::uint32_t i : order_) {
    std::size_t k = 0;
    for (float r = sizes.largest / 2; spheres[i].r <= r && k + 1 < octaves.size(); r /= 2) ++k;
    octaves[k].push_back(i);
  }
  for (std::size_t k = octaves.size(); k-- > 0;)
    if (!octaves[k].empty()) add_pencils(octaves[k], std::ldexp(sizes.largest, -static_cast<int>(k)));
}

/// Places for the spheres of `order` behind those that there are: in pencils, but for those larger than
/// `largest`, which come alone.
void SweepOrder::add_pencils(std::vector<std::uint32_t>& order, float largest) {
  const double width = 2.0 * (largest + skin_);
  // Few spheres in much room do not need more pencils than there are spheres.
  const int most_across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(order.size()))));
  const auto pencils_across = [&](std::size_t k) {
    const double length = edges_[k] * static_cast<double>(region_.extent[k]) * 0x1p-32;
    const int count = std::min(most_across, count_of_parts(length, width));
    return count > 1 && region_.wraps(k) ? count & ~1 : count;
  };
  const int across_y = pencils_across(1), across_z = pencils_across(2);
  const auto pencils = static_cast<std::size_t>(across_y) * static_cast<std::size_t>(across_z);
  place_.resize(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) {
    const SoftSphere& s = spheres_[order[n]];
    place_[n] = static_cast<std::uint32_t>(s.r > largest
                                               ? pencils
                                               : static_cast<std::size_t>(region_.part(s, 2, across_z)) *
                                                         static_cast<std::size_t>(across_y) +
                                                     static_cast<std::size_t>(region_.part(s, 1, across_y)));
  }
  counting_sort(place_, pencils + 1, start_);
  sorted_.resize(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) sorted_[place_[n]] = order[n];

  for (int colour = 0; colour < 4; ++colour) {
    std::vector<Pencil> all;
    for (int z = colour / 2; z < across_z; z += 2) {
      for (int y = colour % 2; y < across_y; y += 2) {
        const auto p =
            static_cast<std::size_t>(z) * static_cast<std::size_t>(across_y) + static_cast<std::size_t>(y);
        all.push_back({start_[p], start_[p + 1]});
      }
    }
    const std::size_t chains = std::max<std::size_t>(1, all.size() / pencils_per_chain);
    phases_.emplace_back();
    for (std::size_t c = 0; c < chains; ++c) {
      const auto part = [&](std::size_t n) {
        return all.begin() + static_cast<std::ptrdiff_t>(all.size() * n / chains);
      };
      add_chain(sorted_, {part(c), part(c + 1)});
    }
  }
  phases_.emplace_back();
  add_chain(sorted_, {{start_[pencils], start_[pencils + 1]}});
  std::erase_if(phases_, [](const auto& chains) { return chains.empty(); });
}

void SweepOrder::add_chain(const std::vector<std::uint32_t>& order, std::vector<Pencil> live) {
  const std::size_t first = sphere_at_.size() / lanes;
  const auto forget_the_empty = [&] { std::erase_if(live, [](const Pencil& p) { return p.next == p.end; }); };
  forget_the_empty();
  while (!live.empty()) {
    // A turn for every pencil; no pencil twice within a group.
    if (live.size() < lanes) fill_group();
    for (Pencil& p : live) sphere_at_.push_back(order[p.next++]);
    forget_the_empty();
  }
  fill_group();
  if (sphere_at_.size() / lanes > first) phases_.back().push_back({first, sphere_at_.size() / lanes});
}

}  // namespace bernal
