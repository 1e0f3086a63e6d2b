#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>
#include <vector>

#include "core/large_pages.hpp"

namespace bernal {

/// Memory for many short arrays that are all given up at the same time and made anew. It is taken from the
/// system in large pieces and kept. Threads may share it. Cost: a lock and a copy for each array.
template <class T>
class RowArena {
 public:
  /// A copy that lives until the next `clear`.
  const T* keep(std::span<const T> items) {
    T* const copy = take(items.size());
    std::uninitialized_copy(items.begin(), items.end(), copy);
    return copy;
  }
  void clear() { piece_ = used_ = 0; }

 private:
  static_assert(std::is_trivially_destructible_v<T>);
  static constexpr std::size_t piece_size = (std::size_t{8} << 20) / sizeof(T);

  T* take(std::size_t count) {
    const std::lock_guard lock(mutex_);
    while (piece_ < pieces_.size() && (used_ + count) * sizeof(T) > pieces_[piece_].bytes()) {
      ++piece_;
      used_ = 0;
    }
    if (piece_ == pieces_.size()) pieces_.emplace_back(std::max(count, piece_size) * sizeof(T));
    T* const begin = static_cast<T*>(pieces_[piece_].begin()) + used_;
    used_ += count;
    return begin;
  }

  std::mutex mutex_;
  std::vector<LargePages> pieces_;
  std::size_t piece_ = 0, used_ = 0;  // where the next array begins
};

}  // namespace bernal
