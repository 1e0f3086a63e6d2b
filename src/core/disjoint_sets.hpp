#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bernal {

/// Disjoint sets of the numbers from 0 to n - 1; each is known by its least member. Cost: O(log n) a call,
/// next to O(1) in practice.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }
  /// The set of every number, sets counted from 0 in the order of their least members.
  std::vector<std::uint32_t> numbered() {
    std::vector<std::uint32_t> number(parent_.size());
    std::uint32_t sets = 0;
    for (std::uint32_t i = 0; i < number.size(); ++i) {
      const std::uint32_t least = find(i);
      number[i] = least == i ? sets++ : number[least];
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace bernal
