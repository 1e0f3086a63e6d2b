#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/large_pages.hpp"

namespace bernal {

/// Memory for many short arrays that are made anew again and again, all at a time: in large pieces, which
/// stay when all arrays are given up. Any thread. Cost: a lock an array, and a copy.
template <class T>
class RowArena {
 public:
  /// A copy that lives until the next `clear`.
  const T* keep(std::span<const T> items) {
    T* const copy = take(items.size());
    std::copy(items.begin(), items.end(), copy);
    return copy;
  }
  void clear() { piece_ = used_ = 0; }

 private:
  static constexpr std::size_t piece_size = (std::size_t{8} << 20) / sizeof(T);
  struct Piece {
    std::unique_ptr<T[]> items;
    std::size_t size;
  };

  T* take(std::size_t count) {
    const std::lock_guard lock(mutex_);
    while (piece_ < pieces_.size() && used_ + count > pieces_[piece_].size) {
      ++piece_;
      used_ = 0;
    }
    if (piece_ == pieces_.size()) {
      const std::size_t size = std::max(count, piece_size);
      pieces_.push_back({std::unique_ptr<T[]>(new T[size]), size});
      prefer_large_pages(pieces_.back().items.get(), size * sizeof(T));
    }
    T* const begin = pieces_[piece_].items.get() + used_;
    used_ += count;
    return begin;
  }

  std::mutex mutex_;
  std::vector<Piece> pieces_;
  std::size_t piece_ = 0, used_ = 0;  // where the next array begins
};

}  // namespace bernal
