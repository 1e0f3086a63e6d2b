#include "soft/size_exchange.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/order.hpp"

namespace bernal {
namespace {

/// The largest excess of a pressure over the mean that counts: a few spheres in a tight corner have far more.
constexpr float most_excess = 3;
constexpr double first_step = 0.012, last_step = 0.1 * first_step, share_of_long_steps = 0.3;
constexpr int bits_a_pass = 11, passes = 3;
/// What few spheres in a bed lose of the gain, in shares of one over the volume in spheres; no more than most
/// of it.
constexpr double lost_at_round_walls = 10, lost_at_flat_walls = 5, least_kept = 0.1;
/// Of what closing a gap gains, what is left of it in a bed.
constexpr double kept_of_classes_in_bed = 0.2;
constexpr double most_gain = 0.07, most_gain_at_walls = 0.105, spread_of_gain = 0.045;
/// Of the classes on both sides of a gap what takes other sizes. From 0.25 to 0.5 it makes no difference.
constexpr double widened_part = 0.35;
/// Fewer spheres are no class; between two classes they lie on the way from one to the other.
constexpr std::size_t fewest_of_class = 6;
/// The share of the way after which classes are as wide as they become, and those at which they begin to be
/// narrowed and end.
constexpr double wide_from = 0.05, narrower_from = 0.3, narrow_from = 0.9;

/// Maps floats to unsigned numbers in the same order.
std::uint32_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

}  // namespace

SizeExchange::SizeExchange(const std::vector<double>& radii, int dimension)
    : dimension_(dimension), given_(radii.begin(), radii.end()), ascending_(smallest_first(radii)) {
  for (const double r : radii) {
    given_logs_.push_back(static_cast<float>(std::log(r)));
    inverse_areas_.push_back(static_cast<float>(std::pow(r, 1 - dimension)));
  }
  radii_ = given_;
  log_radii_ = given_logs_;
  find_classes();
}

/// Classes begin at gaps that no exchange crosses. What a widening closes lessens the gain in proportion to
/// its share of the way from the smallest size to the largest, and the more the fewer there are on one side
/// of it. The variance is that of ln r within what exchanges can reach (Welford).
void SizeExchange::find_classes() {
  const std::size_t n = ascending_.size();
  if (n == 0) return;
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < n; ++k)
    if (k == 0 || log_at(k) - log_at(k - 1) >= longest_way) begins.push_back(k);
  begins.push_back(n);
  const std::size_t classes = begins.size() - 1;
  const auto members_of = [&](std::size_t c) { return begins[c + 1] - begins[c]; };
  double lost = 0, lost_in_bed = 0;
  std::vector<bool> is_joined(classes, false);  // to the class before
  std::size_t before = classes;                 // the last one that is a class
  for (std::size_t c = 0; c < classes; ++c) {
    if (members_of(c) < fewest_of_class) continue;
    const std::size_t below = std::exchange(before, c);
    if (below == classes) continue;
    const std::size_t end = begins[below + 1], at = begins[c];
    const double gap = log_at(at) - log_at(end - 1);
    if (gap > farthest) continue;
    const auto fewer = static_cast<double>(std::min(members_of(below), members_of(c)));
    const auto part = static_cast<std::size_t>(widened_part * fewer);
    bridges_.push_back({end - part, at + part});
    for (std::size_t k = below + 1; k <= c; ++k) is_joined[k] = true;
    const double balance = 2 * fewer / static_cast<double>(members_of(below) + members_of(c));
    const double gained = std::sqrt(balance) * gap * (1 - gap / farthest);
    lost += gap - gained;
    lost_in_bed += gap - kept_of_classes_in_bed * gained;
  }
  double way = 0, sum = 0, mean = 0, squares = 0, members = 0;
  for (std::size_t c = 0; c < classes; ++c) {
    if (is_joined[c]) {
      way += log_at(begins[c]) - log_at(begins[c] - 1);
    } else {
      sum += squares;
      mean = squares = members = 0;
    }
    way += log_at(begins[c + 1] - 1) - log_at(begins[c]);
    for (std::size_t k = begins[c]; k < begins[c + 1]; ++k) {
      const double away = log_at(k) - mean;
      mean += away / ++members;
      squares += away * (log_at(k) - mean);
    }
  }
  spread_ = std::sqrt((sum + squares) / static_cast<double>(n));
  if (way > 0) {
    ease_ = 1 - lost / way;
    ease_in_bed_ = 1 - lost_in_bed / way;
  }
}

void SizeExchange::set(std::uint32_t sphere, float log_radius) {
  log_radii_[sphere] = log_radius;
  radii_[sphere] = std::exp(log_radius);
  inverse_areas_[sphere] = std::exp(static_cast<float>(1 - dimension_) * log_radius);
}

bool SizeExchange::widen(double share) {
  if (bridges_.empty() || share == share_) return false;
  share_ = share;
  for (const Bridge& bridge : bridges_) {
    const double low = log_at(bridge.first), high = log_at(bridge.last - 1);
    const double step = (high - low) / static_cast<double>(bridge.last - 1 - bridge.first);
    for (std::size_t k = bridge.first; k < bridge.last; ++k) {
      const double on_line = low + step * static_cast<double>(k - bridge.first);
      set(ascending_[k], static_cast<float>((1 - share) * log_at(k) + share * on_line));
    }
  }
  if (share == 0) radii_ = given_;
  return true;
}

/// By radius, and by sphere where radii are equal: a radix sort.
void SizeExchange::sort_wishes() {
  constexpr std::uint32_t mask = (1u << bits_a_pass) - 1;
  sorted_.resize(wishes_.size());
  for (int pass = 0; pass < passes; ++pass) {
    const auto digit = [&](const Wish& w) { return ordered(w.first) >> (bits_a_pass * pass) & mask; };
    std::array<std::uint32_t, mask + 1> next{};
    for (const Wish& w : wishes_) ++next[digit(w)];
    std::exclusive_scan(next.begin(), next.end(), next.begin(), 0u);
    for (const Wish& w : wishes_) sorted_[next[digit(w)]++] = w;
    wishes_.swap(sorted_);
  }
}

const std::vector<std::uint32_t>& SizeExchange::deal(const std::vector<float>& forces, double step) {
  const std::size_t n = forces.size();
  to_.resize(n);
  pressures_.resize(n);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += pressures_[i] = forces[i] * inverse_areas_[i];
  if (!(sum > 0)) {  // nothing is squeezed
    std::iota(to_.begin(), to_.end(), 0u);
    return to_;
  }
  const auto inverse_mean = static_cast<float>(static_cast<double>(n) / sum);
  const auto way = static_cast<float>(step);
  wishes_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i)
    wishes_[i] = {log_radii_[i] - way * std::min(pressures_[i] * inverse_mean - 1, most_excess), i};
  sort_wishes();
  for (std::size_t k = 0; k < n; ++k) to_[wishes_[k].second] = ascending_[k];
  return to_;
}

double SizeExchange::gain(const WallsAround& around) const {
  const double gain = (around.has_walls ? most_gain_at_walls : most_gain) *
                      (around.in_bed ? ease_in_bed_ : ease_) * (1 - std::exp(-spread_ / spread_of_gain));
  const double lost = (around.is_round ? lost_at_round_walls : lost_at_flat_walls) / around.volume_in_spheres;
  return 1 + std::max(gain - lost, least_kept * gain);
}

double exchange_step(double done) {
  if (done < share_of_long_steps) return first_step;
  return first_step *
         std::pow(last_step / first_step, (done - share_of_long_steps) / (1 - share_of_long_steps));
}

double widening(double done) {
  constexpr double parts = 600;  // so many changes, not one for each exchange
  done = std::floor(parts * done) / parts;
  return std::min(done / wide_from,
                  std::clamp((narrow_from - done) / (narrow_from - narrower_from), 0.0, 1.0));
}

double energy_of(const std::vector<float>& squeeze) {
  return 0.5 * std::accumulate(squeeze.begin(), squeeze.end(), 0.0) / static_cast<double>(squeeze.size());
}

}  // namespace bernal
