#include "soft/list_life.hpp"

#include <algorithm>
#include <cmath>

namespace bernal {
namespace {

/// In sweeps. With half of the skin a sweep costs a quarter less; a build costs as much as ten sweeps.
constexpr int long_life = 80, short_life = 30;
/// The least skin, over the largest.
constexpr float thinnest = 0.25f;
constexpr int longest_patience = 16;

}  // namespace

FarthestMoves FarthestMoves::of_parts(std::vector<float> squares) {
  constexpr double most = 0.9;
  const double all = std::sqrt(std::ranges::max(squares));
  const auto parts = static_cast<double>(squares.size());
  const auto nth = squares.begin() + static_cast<std::ptrdiff_t>(std::min(parts - 1, most * parts));
  std::ranges::nth_element(squares, nth);
  return {std::sqrt(*nth), all};
}

/// In lengths a sweep. Before the first sweep it is not known, and spheres are at their fastest.
double ListLife::speed_of(double moved, double limit) const {
  return is_over_ ? limit : std::max((moved - moved_) / std::max(1, sweeps_), 1e-9);
}

/// Shorter lists cost less if long ones would last long.
void ListLife::choose_skin() {
  const float skin = skin_;
  if (age_ > long_life) skin_ = std::max(thinnest * thickest_skin_, 0.5f * skin);
  if (age_ < short_life) skin_ = std::min(thickest_skin_, 2 * skin);
}

void ListLife::begin() {
  grown_ = 0;
  age_ = 0;
  is_over_ = false;
}

/// `limit` belongs to the skin before this look.
void ListLife::looked(double moved, double limit, double speed) {
  moved_ = moved;
  age_ += sweeps_;
  sweeps_ = 0;
  patience_ = static_cast<int>(std::clamp(0.5 * (limit - moved) / speed, 1.0, double{longest_patience}));
}

}  // namespace bernal
