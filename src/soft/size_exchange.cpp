#include "soft/size_exchange.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/order.hpp"

namespace bernal {
namespace {

/// The largest excess of a pressure over the mean that counts: a few spheres in a tight corner have far more.
constexpr float most_excess = 3;
constexpr double first_step = 0.012, last_step = 0.1 * first_step, share_of_long_steps = 0.3;
constexpr int bits_a_pass = 11, passes = 3;
constexpr double most_gain = 0.07, most_gain_at_walls = 0.105, spread_of_gain = 0.045;

/// The variance of ln r within groups; a group ends where the next size is out of reach.
double variance_of_groups(const std::vector<double>& radii, const std::vector<std::uint32_t>& ascending) {
  double sum = 0, mean = 0, squares = 0, members = 0;  // of the present group: Welford
  for (std::size_t k = 0; k < ascending.size(); ++k) {
    const double x = std::log(radii[ascending[k]]);
    if (k > 0 && x - std::log(radii[ascending[k - 1]]) >= SizeExchange::longest_way) {
      sum += squares;
      mean = squares = members = 0;
    }
    const double away = x - mean;
    mean += away / ++members;
    squares += away * (x - mean);
  }
  return radii.empty() ? 0 : (sum + squares) / static_cast<double>(radii.size());
}

/// Maps floats to unsigned numbers in the same order.
std::uint32_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

}  // namespace

SizeExchange::SizeExchange(const std::vector<double>& radii, int dimension)
    : ascending_(smallest_first(radii)) {
  for (const double r : radii) {
    log_radii_.push_back(static_cast<float>(std::log(r)));
    inverse_areas_.push_back(static_cast<float>(std::pow(r, 1 - dimension)));
  }
  spread_ = std::sqrt(variance_of_groups(radii, ascending_));
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

double gain_by_exchange(double spread, bool has_walls) {
  return 1 + (has_walls ? most_gain_at_walls : most_gain) * (1 - std::exp(-spread / spread_of_gain));
}

double exchange_step(double done) {
  if (done < share_of_long_steps) return first_step;
  return first_step *
         std::pow(last_step / first_step, (done - share_of_long_steps) / (1 - share_of_long_steps));
}

double energy_of(const std::vector<float>& squeeze) {
  return 0.5 * std::accumulate(squeeze.begin(), squeeze.end(), 0.0) / static_cast<double>(squeeze.size());
}

}  // namespace bernal
