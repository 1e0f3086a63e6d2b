#include "work/supply.hpp"

#include <algorithm>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "core/rounding.hpp"
#include "sizes/enlarged.hpp"

namespace bernal {
namespace {

/// The window's share of the spheres that may come.
constexpr double window_share = 0.002;
/// Taking out no more than this share makes the result exactly the drawn sequence less its tail.
constexpr double trim_share = 0.002;

/// Of the tail for each radius that is kept.
constexpr std::size_t most_cut_off = 1000;

}  // namespace

void Supply::refuse_count(const Target& target) {
  throw Error(
      ErrorCode::bad_scene,
      "there would be more than 2^31 spheres of these sizes: check the units, use larger ones or ask for "
      "a count",
      target.where);
}

Supply::Supply(const Source& source, double volume, const Target& target, double fraction)
    : dimension_(source.dimension), cut_(source.cut) {
  const bool counts_drawn = target.packing_fraction.has_value();
  const Enlarged with_coats(source.radii, source.coat);
  const SizeDistribution& counted =
      counts_drawn || source.coat == 0 ? source.radii : static_cast<const SizeDistribution&>(with_coats);
  const double mean_volume = ball_volume(dimension_, 1) * counted.moment(dimension_);
  fraction = target.packing_fraction.value_or(fraction);
  const double expected = target.count ? static_cast<double>(*target.count) : fraction * volume / mean_volume;
  if (!(expected < most_spheres)) refuse_count(target);
  RadiusSequence sequence(source.radii, source.seed, source.draw);
  radii_.reserve(static_cast<std::size_t>(expected * 1.01) + 16);
  double filled = 0;
  const auto add = [&](double drawn) {
    const double r = sum_rounded_up(drawn, source.coat);
    radii_.push_back(r);
    if (source.coat > 0) drawn_.push_back(drawn);
    filled += ball_volume(dimension_, counts_drawn ? drawn : r);
  };
  for (const double r : source.first) add(r);
  std::uint64_t drawn = 0;
  while (target.count ? radii_.size() < static_cast<std::size_t>(*target.count)
                      : filled < fraction * volume) {
    constexpr std::uint64_t between_looks = 4096;
    if (++drawn % between_looks == 0) throw_if_interrupted();
    const double r = sequence.next();
    if (sum_rounded_up(r, source.coat) > source.cut) {
      if (++cut_off_ > most_cut_off * (radii_.size() + 1000))
        throw Error(
            ErrorCode::bad_scene,
            "next to none of these sizes has room in the container; use smaller ones or check the units",
            target.where);
      continue;
    }
    add(r);
  }
  const auto [smallest, largest] = std::ranges::minmax(radii_);
  smallest_ = smallest;
  largest_ = largest;
  width_ = smallest_ == largest_
               ? 1
               : std::max<std::size_t>(16, static_cast<std::size_t>(window_share * expected));
  open_window();
}

Supply Supply::of(const std::vector<std::uint32_t>& tags) const {
  const auto chosen = [&](const std::vector<double>& from) {
    std::vector<double> values;
    if (from.empty()) return values;
    values.reserve(tags.size());
    for (const std::uint32_t tag : tags) values.push_back(from[tag]);
    return values;
  };
  Supply some = *this;
  some.radii_ = chosen(radii_);
  some.drawn_ = chosen(drawn_);
  const auto [smallest, largest] = std::ranges::minmax(some.radii_);
  some.smallest_ = smallest;
  some.largest_ = largest;
  some.set_placed({});
  return some;
}

void Supply::divide_by(double unit) {
  for (double& r : radii_) r /= unit;
  for (double& r : drawn_) r /= unit;
  cut_ /= unit;
  smallest_ /= unit;
  largest_ /= unit;
}

void Supply::multiply_by(double factor) {
  for (double& r : radii_) r *= factor;
  smallest_ *= factor;
  largest_ *= factor;
  scale_ *= factor;
}

void Supply::open_window() {
  for (; window_.size() < width_ && next_ < radii_.size(); ++next_)
    if (!std::ranges::binary_search(taken_first_, next_)) window_.push_back(next_);
}

void Supply::take(std::size_t k) {
  window_.erase(window_.begin() + static_cast<std::ptrdiff_t>(k));
  open_window();
}

void Supply::take_first(const std::vector<std::uint32_t>& tags) {
  taken_first_ = tags;
  in_sequence_ = tags.empty();
  window_.clear();
  next_ = 0;
  open_window();
}

void Supply::set_placed(const std::vector<bool>& placed, bool in_sequence) {
  in_sequence_ = in_sequence;
  window_.clear();
  taken_first_.clear();
  next_ = static_cast<std::uint32_t>(placed.size());
  for (std::uint32_t tag = 0; tag < next_; ++tag)
    if (!placed[tag]) window_.push_back(tag);
  open_window();
}

std::size_t Supply::count_filling(double volume) const {
  std::size_t count = 0;
  while (count < radii_.size() && volume > 0) volume -= ball_volume(dimension_, radii_[count++]);
  return count;
}

std::size_t Supply::passed_over() const {
  // The window is ascending and ends in spheres that nothing later was placed after, but for those taken
  // first.
  std::size_t untouched = 0;
  for (std::uint32_t tag = next_; tag-- > 0 && untouched < window_.size();) {
    if (std::ranges::binary_search(taken_first_, tag)) continue;
    if (window_[window_.size() - 1 - untouched] != tag) break;
    ++untouched;
  }
  return window_.size() - untouched;
}

bool Supply::trimming_is_cheap() const {
  if (!in_sequence_) return false;
  const std::size_t placed = next_ - window_.size();
  const std::size_t beyond = placed - std::min<std::size_t>(placed, first_missing());
  return static_cast<double>(beyond) <= trim_share * static_cast<double>(placed);
}

}  // namespace bernal
