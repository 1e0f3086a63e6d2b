#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace bernal {

/// Turns the lengths of lists, that of list i at first[i + 1] and 0 at first[0], into where each begins when
/// they stand end to end. In 64 bits: the neighbours of 10^8 spheres are more than 32 bits count.
inline void begin_end_to_end(std::vector<std::size_t>& first) {
  std::partial_sum(first.begin(), first.end(), first.begin());
}

/// Puts lists that were made in blocks end to end into `all`; `first` as above.
template <class T>
void put_end_to_end(const std::vector<std::vector<T>>& blocks, std::vector<std::size_t>& first,
                    std::vector<T>& all) {
  begin_end_to_end(first);
  all.resize(first.back());
  auto at = all.begin();
  for (const auto& block : blocks) at = std::ranges::copy(block, at).out;
}

}  // namespace bernal
