#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "soft/coloured_spheres.hpp"

namespace bernal {

/// This processor as a `Device` of ColouredSpheres: one call after the other. What it computes a GPU computes
/// to the bit.
class HostDevice {
 public:
  template <class T>
  class Array {
   public:
    std::size_t size() const { return values_.size(); }
    T* data() const { return const_cast<T*>(values_.data()); }
    void resize_anew(std::size_t n) { values_.assign(n, poison()); }

   private:
    static T poison() {
      T value;
      std::fill_n(reinterpret_cast<unsigned char*>(&value), sizeof value, static_cast<unsigned char>(0x7b));
      return value;
    }
    std::vector<T> values_;
  };

  std::string name() const { return "this processor"; }
  template <class T>
  void to(Array<T>& array, const std::vector<T>& values) {
    std::ranges::copy(values, array.data());
  }
  template <class T>
  std::vector<T> from(const Array<T>& array, std::size_t count) {
    return {array.data(), array.data() + count};
  }
  template <class T>
  void set(Array<T>& array, std::size_t k, const T& value) {
    array.data()[k] = value;
  }
  template <class T>
  T at(const Array<T>& array, std::size_t k) {
    return array.data()[k];
  }
  template <class T>
  void fill_zero(Array<T>& array, std::size_t n) {
    std::fill_n(array.data(), n, T{});
  }
  template <class Function>
  void each(std::uint32_t n, const Function& function) {
    for (std::uint32_t i = 0; i < n; ++i) function(i);
  }
  void sort(Array<std::uint32_t>& keys, Array<std::uint32_t>& values, std::size_t n, int bits) {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t k) { return keys.data()[k] & mask; });
    for (Array<std::uint32_t>* array : {&keys, &values}) {
      const std::vector<std::uint32_t> before = from(*array, n);
      for (std::size_t k = 0; k < n; ++k) array->data()[k] = before[order[k]];
    }
  }
  void sums_before(Array<std::uint32_t>& array, std::size_t n) {
    array.data()[n] = 0;
    std::exclusive_scan(array.data(), array.data() + n + 1, array.data(), 0u);
  }
  void wait() {}
};

}  // namespace bernal
