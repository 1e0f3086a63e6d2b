#include "soft/sweep_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/parallel.hpp"

namespace bernal {
namespace {

/// The share of the spheres, the largest ones, that is swept apart if the others are smaller.
constexpr double share_of_large = 0.01;
/// A level must hold more than this share of the spheres, with all smaller ones: each level costs a search
/// for every sphere.
constexpr double share_of_level = 0.6;
constexpr std::size_t most_levels = 24;
/// A chain has at least the spheres of so many pencils as long as the longest: with hardly more than `lanes`
/// of them not all groups could be full.
constexpr double pencils_a_chain = 20;
/// The fewest spheres of a chain: to sweep them takes about as long as threads take to meet.
constexpr double spheres_a_chain = 2048;
/// Pencils are cut until a colour has so many chains, into parts of at least so many widths.
constexpr double chains_a_colour = 8, shortest_part = 2;
/// Spheres whose radii differ by less than this part of an octave are alike.
constexpr double classes_per_octave = 4;
constexpr std::size_t most_classes = 64;

bool is_there(const SoftSphere& s) { return s.r > 0; }

float quantile_of_most(std::vector<float> radii) {
  const auto nth = radii.begin() +
                   static_cast<std::ptrdiff_t>((1 - share_of_large) * static_cast<double>(radii.size() - 1));
  std::nth_element(radii.begin(), nth, radii.end());
  return *nth;
}

int count_of_parts(double length, double width) {
  return std::max(1, static_cast<int>(std::min(length / width, 1e6)));
}

}  // namespace

SoftSizes::SoftSizes(const std::vector<float>& radii) {
  large = quantile_of_most(radii);
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
                      const std::array<double, 3>& edges, const SoftSizes& sizes, float skin, bool by_octaves,
                      bool in_threads) {
  spheres_ = spheres;
  region_ = region;
  edges_ = edges;
  skin_ = skin;
  in_threads_ = in_threads;
  phases_.clear();
  sphere_at_.clear();

  // One key for the part of the axis and the class of the radius.
  const auto count = static_cast<std::size_t>(std::ranges::count_if(spheres, is_there));
  const double length = edges[0] * static_cast<double>(region.extent[0]) * 0x1p-32;
  const std::size_t along =
      std::min(count + 1, static_cast<std::size_t>(count_of_parts(length, 2.0 * sizes.large)));
  const std::size_t keys = along * (sizes.equal ? 1 : most_classes);
  const SoftParts parts(region, 0, static_cast<int>(along));
  const auto key_of = [&](std::size_t i) {
    if (!is_there(spheres[i])) return keys;
    const auto part = static_cast<std::size_t>(parts.at(spheres[i]));
    if (sizes.equal) return part;
    const double octaves = std::log2(sizes.largest / spheres[i].r);
    return part + along * std::min(most_classes - 1, static_cast<std::size_t>(classes_per_octave * octaves));
  };
  order_.resize(count);
  const auto put = [&](std::uint32_t place, std::size_t i) { order_[place] = static_cast<std::uint32_t>(i); };
  put_into_buckets(spheres.size(), keys, key_of, put, start_, room_, in_threads_);

  if (!by_octaves) {
    add_pencils(order_, sizes.large);
    return;
  }
  // Large spheres come last, after the small ones have given way to them.
  std::array<std::vector<std::uint32_t>, most_levels> octaves;
  for (const std::uint32_t i : order_) {
    std::size_t k = 0;
    for (float r = sizes.largest / 2; spheres[i].r <= r && k + 1 < octaves.size(); r /= 2) ++k;
    octaves[k].push_back(i);
  }
  for (std::size_t k = octaves.size(); k-- > 0;)
    if (!octaves[k].empty()) add_pencils(octaves[k], std::ldexp(sizes.largest, -static_cast<int>(k)));
}

/// Sorts `order` by pencil into `sorted_`. Spheres larger than `largest` come behind all pencils.
void SweepOrder::sort_into_pencils(const std::vector<std::uint32_t>& order, float largest,
                                   const std::array<int, 3>& across) {
  const auto [x, y, z] = across;
  const auto pencils = static_cast<std::size_t>(x * y * z);
  const SoftParts along_x(region_, 0, x), along_y(region_, 1, y), along_z(region_, 2, z);
  const auto pencil_of = [&, y = y, z = z](std::size_t n) {
    const SoftSphere& s = spheres_[order[n]];
    return s.r > largest ? pencils
                         : static_cast<std::size_t>((along_x.at(s) * z + along_z.at(s)) * y + along_y.at(s));
  };
  sorted_.resize(order.size());
  const auto put = [&](std::uint32_t place, std::size_t n) { sorted_[place] = order[n]; };
  put_into_buckets(order.size(), pencils + 1, pencil_of, put, start_, room_, in_threads_);
}

/// The number of parts that pencils are cut into, so that every colour has enough chains for threads.
int SweepOrder::parts_along(std::size_t spheres, std::size_t longest, double width) const {
  const auto n = static_cast<double>(spheres);
  const double chains = n / (4 * pencils_a_chain * static_cast<double>(longest));
  const double wanted = std::min(chains_a_colour, n / (8 * spheres_a_chain));
  if (chains >= wanted) return 1;
  const double length = edges_[0] * static_cast<double>(region_.extent[0]) * 0x1p-32;
  const int most = count_of_parts(length, shortest_part * width) & ~1;
  return std::max(1, std::min(most, 2 * static_cast<int>(std::ceil(wanted / chains))));
}

/// Appends places for the spheres of `order`: in pencils, and then those larger than `largest` in pencils of
/// their own.
void SweepOrder::add_pencils(const std::vector<std::uint32_t>& order, float largest) {
  const double width = 2.0 * (largest + skin_);
  // No more pencils than spheres.
  const int most_across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(order.size()))));
  const auto pencils_across = [&](std::size_t k) {
    const double length = edges_[k] * static_cast<double>(region_.extent[k]) * 0x1p-32;
    const int count = std::min(most_across, count_of_parts(length, width));
    return count > 1 && region_.wraps(k) ? count & ~1 : count;
  };
  std::array<int, 3> across = {1, pencils_across(1), pencils_across(2)};
  sort_into_pencils(order, largest, across);
  std::uint32_t longest = 1;
  for (std::size_t p = 0; p + 2 < start_.size(); ++p) longest = std::max(longest, start_[p + 1] - start_[p]);
  across[0] = parts_along(order.size(), longest, width);
  if (across[0] > 1) sort_into_pencils(order, largest, across);

  drafted_ = 0;
  for (int colour = 0; colour < 8; ++colour) {
    std::vector<Pencil> pencils;
    for (int x = colour / 4; x < across[0]; x += 2) {
      for (int z = colour / 2 % 2; z < across[2]; z += 2) {
        for (int y = colour % 2; y < across[1]; y += 2) {
          const auto p = static_cast<std::size_t>((x * across[2] + z) * across[1] + y);
          if (start_[p] < start_[p + 1]) pencils.push_back({start_[p], start_[p + 1] - start_[p]});
        }
      }
    }
    draft_phase(pencils);
  }
  parallel_for_if(in_threads_, drafted_, [&](std::size_t d) { put_together(drafts_[d]); });
  add_drafts();
  const std::size_t all = start_.size() - 2;
  const std::vector<std::uint32_t> larger(sorted_.begin() + start_[all], sorted_.end());
  if (!larger.empty()) add_pencils(larger, radius_of_most(larger));
}

/// The radius that hardly any of them exceeds.
float SweepOrder::radius_of_most(const std::vector<std::uint32_t>& order) const {
  std::vector<float> radii;
  for (const std::uint32_t i : order) radii.push_back(spheres_[i].r);
  return quantile_of_most(radii);
}

/// Divides the pencils of a colour into chains with similar numbers of spheres.
void SweepOrder::draft_phase(const std::vector<Pencil>& pencils) {
  if (pencils.empty()) return;
  std::size_t spheres = 0, longest = 0;
  for (const Pencil& p : pencils) {
    spheres += p.count;
    longest = std::max<std::size_t>(longest, p.count);
  }
  auto chains = static_cast<std::size_t>(
      std::max(1.0, static_cast<double>(spheres) /
                        std::max(spheres_a_chain, pencils_a_chain * static_cast<double>(longest))));
  // A multiple of two, four or eight, for as many threads.
  chains &= ~(std::bit_floor(std::min<std::size_t>(chains, 8)) - 1);
  phases_.emplace_back();
  std::size_t number = 0, before = 0;
  Draft* chain = &new_draft();
  for (const Pencil& p : pencils) {
    const std::size_t its = (2 * before + p.count) * chains / (2 * spheres);
    if (std::exchange(number, its) < its && !chain->pencils.empty()) chain = &new_draft();
    chain->pencils.push_back(p);
    before += p.count;
  }
}

/// A draft of the last phase, without pencils.
SweepOrder::Draft& SweepOrder::new_draft() {
  if (drafted_ == drafts_.size()) drafts_.emplace_back();
  Draft& draft = drafts_[drafted_++];
  draft.phase = phases_.size() - 1;
  draft.pencils.clear();
  return draft;
}

/// Spreads every pencil evenly over all groups, so that all end together. A sphere whose group is full, or
/// has another sphere of its pencil, waits for the next group; a group with room left takes spheres that are
/// due later.
void SweepOrder::put_together(Draft& chain) const {
  const std::vector<Pencil>& pencils = chain.pencils;
  std::vector<std::uint32_t>& sphere_at = chain.sphere_at;
  std::size_t spheres = 0, groups = 0;
  for (const Pencil& p : pencils) {
    spheres += p.count;
    groups = std::max<std::size_t>(groups, p.count);
  }
  groups = std::max(groups, (spheres + lanes - 1) / lanes);
  chain.place.clear();
  chain.place.reserve(spheres);
  for (const Pencil& p : pencils) {
    // (2k + 1) groups / 2 count, rounded down, for k = 0, 1, … without dividing.
    const std::size_t parts = 2 * std::size_t{p.count}, step = 2 * groups / parts, more = 2 * groups % parts;
    std::size_t due = groups / parts, rest = groups % parts;
    for (std::size_t k = 0; k < p.count; ++k) {
      chain.place.push_back(static_cast<std::uint32_t>(due));
      rest += more;
      const bool carries = rest >= parts;
      due += step + carries;
      rest -= carries ? parts : 0;
    }
  }
  counting_sort(chain.place, groups, chain.due);
  chain.turns.resize(spheres);
  std::size_t n = 0;
  for (std::uint32_t p = 0; p < pencils.size(); ++p)
    for (std::uint32_t k = 0; k < pencils[p].count; ++k)
      chain.turns[chain.place[n++]] = {sorted_[pencils[p].first + k], p};

  std::vector<std::size_t> last_group(pencils.size(), std::size_t{nobody});
  std::vector<Turn> waiting, still_waiting;
  sphere_at.clear();
  sphere_at.reserve(groups * lanes);
  n = 0;
  for (std::size_t g = 0; n < spheres || !waiting.empty(); ++g) {
    const std::size_t full = sphere_at.size() + lanes, ahead = chain.due[std::min(g + 2, groups)];
    const auto take = [&](const Turn& turn) {
      if (sphere_at.size() == full || last_group[turn.pencil] == g) {
        still_waiting.push_back(turn);
      } else {
        sphere_at.push_back(turn.sphere);
        last_group[turn.pencil] = g;
      }
    };
    for (const Turn& turn : waiting) take(turn);
    while (sphere_at.size() < full && n < ahead) take(chain.turns[n++]);
    sphere_at.resize(full, nobody);
    waiting.swap(still_waiting);
    still_waiting.clear();
  }
}

/// Appends the chains that were put together.
void SweepOrder::add_drafts() {
  for (std::size_t d = 0; d < drafted_; ++d) {
    const std::vector<std::uint32_t>& sphere_at = drafts_[d].sphere_at;
    const std::size_t first = sphere_at_.size() / lanes;
    sphere_at_.insert(sphere_at_.end(), sphere_at.begin(), sphere_at.end());
    phases_[drafts_[d].phase].push_back({first, first + sphere_at.size() / lanes});
  }
}

}  // namespace bernal
