#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bernal {

/// Lists of neighbours without order, one behind the other; one that needs more room moves to the end.
class NeighborPool {
 public:
  using Id = std::uint32_t;

  /// Empty lists, with room for about `expected` neighbours each.
  void start(std::size_t count, double expected) {
    const std::uint32_t room = std::max(8u, static_cast<std::uint32_t>(1.5 * expected));
    lists_.resize(count);
    for (std::size_t i = 0; i < count; ++i) lists_[i] = {i * room, 0, room};
    pool_.resize(count * room);
    longest_ = 0;
  }

  std::span<const Id> of(Id i) const { return {pool_.data() + lists_[i].begin, lists_[i].count}; }
  std::size_t longest() const { return longest_; }
  double mean() const {
    std::size_t sum = 0;
    for (const List& list : lists_) sum += list.count;
    return static_cast<double>(sum) / static_cast<double>(std::max<std::size_t>(1, lists_.size()));
  }

  void prefetch(Id i) const { __builtin_prefetch(&lists_[i]); }
  void prefetch_list(Id i) const {
    const Id* const begin = pool_.data() + lists_[i].begin;
    __builtin_prefetch(begin);
    __builtin_prefetch(begin + 16);
  }

  void append(Id to, Id id) {
    List& list = lists_[to];
    if (list.count == list.room) grow(list);
    pool_[list.begin + list.count++] = id;
    longest_ = std::max<std::size_t>(longest_, list.count);
  }
  /// Precondition: it is in the list.
  void remove(Id from, Id id) {
    List& list = lists_[from];
    Id* const begin = pool_.data() + list.begin;
    *std::find(begin, begin + list.count, id) = begin[list.count - 1];
    --list.count;
  }
  void clear(Id i) { lists_[i].count = 0; }

 private:
  struct List {
    std::size_t begin = 0;
    std::uint32_t count = 0, room = 0;
  };

  void grow(List& list) {
    const std::size_t begin = pool_.size();
    pool_.resize(begin + 2 * std::size_t{list.room});
    std::copy_n(pool_.begin() + static_cast<std::ptrdiff_t>(list.begin), list.count,
                pool_.begin() + static_cast<std::ptrdiff_t>(begin));
    list = {begin, list.count, 2 * list.room};
  }

  std::vector<List> lists_;
  std::vector<Id> pool_;
  std::size_t longest_ = 0;
};

}  // namespace bernal
