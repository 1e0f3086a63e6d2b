#pragma once
#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "bernal/verify/certificate.hpp"

namespace bernal::verify {

inline bool worse(const Certificate::Overlap& a, const Certificate::Overlap& b) {
  return std::tuple(-a.ratio, a.pair) < std::tuple(-b.ratio, b.pair);
}
inline bool worse(const Certificate::Protrusion& a, const Certificate::Protrusion& b) {
  return std::tuple(a.gap, a.sphere) < std::tuple(b.gap, b.sphere);
}

/// The worst so many of what is added. Which they are depends on no order of adding. Cost: O(1) an item;
/// memory twice the limit.
template <class Item>
class WorstOf {
 public:
  explicit WorstOf(std::size_t limit) : limit_(limit) {}

  void add(const Item& item) {
    if (limit_ == 0) return;
    items_.push_back(item);
    if (items_.size() / 2 >= limit_) trim();
  }
  void add(const WorstOf& other) {
    for (const Item& item : other.items_) add(item);
  }
  std::vector<Item> sorted() && {
    trim();
    std::sort(items_.begin(), items_.end(), before);
    return std::move(items_);
  }

 private:
  static bool before(const Item& a, const Item& b) { return worse(a, b); }
  void trim() {
    if (items_.size() <= limit_) return;
    const auto end = items_.begin() + static_cast<std::ptrdiff_t>(limit_);
    std::nth_element(items_.begin(), end, items_.end(), before);
    items_.resize(limit_);
  }

  std::size_t limit_;
  std::vector<Item> items_;
};

}  // namespace bernal::verify
