#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

/// Plain values and arrays of them, one after the other, into an open file, in the form of this machine: from
/// a child process to its parent. Throws std::bad_alloc where the file takes no more.
class PlainWriter {
 public:
  explicit PlainWriter(int file) : file_(file) {}

  template <class T>
  void array(std::span<const T> values) {
    number(values.size());
    bytes(values.data(), values.size_bytes());
  }
  void number(std::uint64_t n) { bytes(&n, sizeof n); }
  void real(double x) { bytes(&x, sizeof x); }
  void text(std::string_view words) { array(std::span(words.data(), words.size())); }
  void points(const std::vector<Vector<3>>& all) {
    static_assert(sizeof(Vector<3>) == 3 * sizeof(double));
    array(std::span(all));
  }

 private:
  void bytes(const void* from, std::size_t size);

  int file_;
};

/// The same out of it, from its beginning.
class PlainReader {
 public:
  /// What was written is not whole.
  struct Cut {};

  explicit PlainReader(int file);

  template <class Array>
  Array array() {
    Array values;
    const std::uint64_t size = number();
    if (size > left_ / sizeof(typename Array::value_type)) throw Cut();
    values.resize(size);
    bytes(values.data(), size * sizeof(typename Array::value_type));
    return values;
  }
  std::uint64_t number() {
    std::uint64_t n = 0;
    bytes(&n, sizeof n);
    return n;
  }
  double real() {
    double x = 0;
    bytes(&x, sizeof x);
    return x;
  }
  std::string text() { return array<std::string>(); }
  std::vector<Vector<3>> points() { return array<std::vector<Vector<3>>>(); }

 private:
  void bytes(void* to, std::size_t size);

  int file_;
  std::uint64_t left_;
};

}  // namespace bernal::cad
