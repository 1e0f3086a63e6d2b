#include "bernal/sizes/even_classes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace bernal {
namespace {

/// Relative to a turn: far more than its rounding error after 2^31 draws, and far below 1.
constexpr double rounding_of_turns = 1e-6;
/// Relative to the sum of all shares.
constexpr double rounding_of_shares = 1e-9;

}  // namespace

EvenClasses::EvenClasses(const SizeDistribution& sizes) {
  double sum = 0;
  for (const double radius : sizes.atoms()) {
    const double share = sizes.cumulative(radius) - sizes.cumulative(std::nextafter(radius, 0.0));
    if (share > 0) classes_.push_back({radius, share});
    sum += share;
  }
  if (classes_.size() < 2 || std::abs(sum - 1) > rounding_of_shares) classes_.clear();
  if (!empty()) c_ = 1 / (2 * static_cast<double>(classes_.size()) - 2);
}

void EvenClasses::wait(std::size_t of, Random& lots) {
  const Class& c = classes_[of];
  const double from = std::ceil((static_cast<double>(c.drawn) + c_) / c.share - rounding_of_turns);
  waiting_.push_back({static_cast<std::uint64_t>(std::min(from, 0x1p62)), lots(), of});
  std::ranges::push_heap(waiting_, std::greater{});
}

double EvenClasses::next(Random& lots) {
  if (draws_++ == 0)
    for (std::size_t k = 0; k < classes_.size(); ++k) wait(k, lots);
  while (!waiting_.empty() && (waiting_.front().key <= draws_ || ready_.empty())) {
    std::ranges::pop_heap(waiting_, std::greater{});
    Turn turn = waiting_.back();
    waiting_.pop_back();
    const Class& c = classes_[turn.of];
    const double by = std::floor((static_cast<double>(c.drawn) + 1 - c_) / c.share + rounding_of_turns) + 1;
    turn.key = static_cast<std::uint64_t>(std::min(by, 0x1p62));
    ready_.push_back(turn);
    std::ranges::push_heap(ready_, std::greater{});
  }
  std::ranges::pop_heap(ready_, std::greater{});
  Class& drawn = classes_[ready_.back().of];
  const std::size_t of = ready_.back().of;
  ready_.pop_back();
  ++drawn.drawn;
  wait(of, lots);
  return drawn.radius;
}

}  // namespace bernal
