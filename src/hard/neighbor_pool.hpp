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

/// Unordered lists of neighbours in one array; a list that needs more space moves to the end. The caller
/// keeps each list's position with the other data of its owner.
class NeighborPool {
 public:
  using Id = std::uint32_t;
  struct List {
    using ArchivedAsBytes = void;
    std::size_t begin = 0;
    std::uint32_t count = 0, room = 0;
  };

  /// Clears, for `lists` lists of about `expected` neighbours each.
  void start(std::size_t lists, double expected) {
    lines_a_list_ = std::max(std::size_t{1}, static_cast<std::size_t>(1.5 * expected / a_line));
    lines_.clear();
    lines_.reserve(lists * lines_a_list_);
    longest_ = 0;
  }
  /// Creates an empty list.
  List make() {
    const std::size_t begin = lines_.size() * a_line;
    lines_.resize(lines_.size() + lines_a_list_);
    return {begin, 0, static_cast<std::uint32_t>(lines_a_list_ * a_line)};
  }

  void archive(Archive& a) { a(lines_, longest_); }

  std::span<const Id> of(const List& list) const { return {ids() + list.begin, list.count}; }
  std::size_t longest() const { return longest_; }

  void prefetch(const List& list) const {
    const Id* const begin = ids() + list.begin;
    bernal::prefetch(begin);
    if (list.count > a_line) bernal::prefetch(begin + a_line);
  }

  void append(List& to, Id id) {
    if (to.count == to.room) grow(to);
    ids()[to.begin + to.count++] = id;
    longest_ = std::max<std::size_t>(longest_, to.count);
  }
  /// Precondition: it is in the list.
  void remove(List& from, Id id) {
    Id* const begin = ids() + from.begin;
    *std::find(begin, begin + from.count, id) = begin[from.count - 1];
    --from.count;
  }
  void replace(List& list, std::span<const Id> others) {
    while (list.room < others.size()) grow(list);
    std::ranges::copy(others, ids() + list.begin);
    list.count = static_cast<std::uint32_t>(others.size());
    longest_ = std::max<std::size_t>(longest_, list.count);
  }

 private:
  static constexpr std::size_t a_line = 16;
  struct alignas(64) Line {
    using ArchivedAsBytes = void;
    Id ids[a_line];
  };

  const Id* ids() const { return lines_.data()->ids; }
  Id* ids() { return lines_.data()->ids; }

  void grow(List& list) {
    const std::size_t begin = lines_.size() * a_line;
    lines_.resize(lines_.size() + 2 * std::size_t{list.room} / a_line);
    std::copy_n(ids() + list.begin, list.count, ids() + begin);
    list = {begin, list.count, 2 * list.room};
  }

  LargePageVector<Line> lines_;
  std::size_t lines_a_list_ = 1;
  std::size_t longest_ = 0;
};

}  // namespace bernal
