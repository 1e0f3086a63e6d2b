#include "near/size_levels.hpp"

#include <algorithm>
#include <cmath>

#include "core/every_dimension.hpp"

namespace bernal {

template <int D>
std::vector<SizeLevel<D>> levels_of(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary,
                                    double widest_gap) {
  constexpr std::size_t most_levels = 1100;  // from the largest double to the smallest
  const double largest = *std::max_element(spheres.r.begin(), spheres.r.end());
  std::vector<SizeLevel<D>> by_octave(most_levels);
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    const double octave = std::floor(std::log2(largest / spheres.r[i]));
    SizeLevel<D>& level = by_octave[std::min(most_levels - 1, static_cast<std::size_t>(octave))];
    level.largest = std::max(level.largest, spheres.r[i]);
    level.members.push_back(i);
  }
  std::erase_if(by_octave, [](const SizeLevel<D>& level) { return level.members.empty(); });
  for (SizeLevel<D>& level : by_octave) {
    level.grid = std::make_unique<PointGrid<D>>(spheres, level.members, boundary,
                                                2 * (1 + widest_gap) * level.largest);
    level.members = {};
  }
  return by_octave;
}

#define BERNAL_INSTANTIATE(D) \
  template std::vector<SizeLevel<D>> levels_of(const Spheres<D>&, const TiltedBoundary<D>&, double);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
