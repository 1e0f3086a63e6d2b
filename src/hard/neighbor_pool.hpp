#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/archive.hpp"
#include "core/large_pages.hpp"
#include "hard/prefetch.hpp"

namespace bernal {

/// Lists of neighbours without order, one behind the other; one that needs more room moves to the end.
class NeighborPool {
 public:
  using Id = std::uint32_t;

  /// Empty lists, with room for about `expected` neighbours each.
  void start(std::size_t count, double expected) {
    const std::size_t lines = std::max(std::size_t{1}, static_cast<std::size_t>(1.5 * expected / a_line));
    lists_.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      lists_[i] = {i * lines * a_line, 0, static_cast<std::uint32_t>(lines * a_line)};
    pool_.resize(count * lines);
    longest_ = 0;
  }

  void archive(Archive& a) { a(lists_, pool_, longest_); }

  std::span<const Id> of(Id i) const { return {ids() + lists_[i].begin, lists_[i].count}; }
  std::size_t longest() const { return longest_; }
  double mean() const {
    std::size_t sum = 0;
    for (const List& list : lists_) sum += list.count;
    return static_cast<double>(sum) / static_cast<double>(std::max<std::size_t>(1, lists_.size()));
  }

  void prefetch(Id i) const { bernal::prefetch(&lists_[i]); }
  void prefetch_list(Id i) const {
    const Id* const begin = ids() + lists_[i].begin;
    bernal::prefetch(begin);
    bernal::prefetch(begin + 16);
  }

  void append(Id to, Id id) {
    List& list = lists_[to];
    if (list.count == list.room) grow(list);
    ids()[list.begin + list.count++] = id;
    longest_ = std::max<std::size_t>(longest_, list.count);
  }
  /// Precondition: it is in the list.
  void remove(Id from, Id id) {
    List& list = lists_[from];
    Id* const begin = ids() + list.begin;
    *std::find(begin, begin + list.count, id) = begin[list.count - 1];
    --list.count;
  }
  void replace(Id of, std::span<const Id> others) {
    List& list = lists_[of];
    while (list.room < others.size()) grow(list);
    std::ranges::copy(others, ids() + list.begin);
    list.count = static_cast<std::uint32_t>(others.size());
    longest_ = std::max<std::size_t>(longest_, list.count);
  }

 private:
  struct List {
    std::size_t begin = 0;
    std::uint32_t count = 0, room = 0;
  };

  static constexpr std::size_t a_line = 16;
  struct alignas(64) Line {
    Id ids[a_line];
  };

  const Id* ids() const { return pool_.data()->ids; }
  Id* ids() { return pool_.data()->ids; }

  void grow(List& list) {
    const std::size_t begin = pool_.size() * a_line;
    pool_.resize(pool_.size() + 2 * std::size_t{list.room} / a_line);
    std::copy_n(ids() + list.begin, list.count, ids() + begin);
    list = {begin, list.count, 2 * list.room};
  }

  LargePageVector<List> lists_;
  LargePageVector<Line> pool_;
  std::size_t longest_ = 0;
};

}  // namespace bernal
