#pragma once
#include <array>
#include <bit>
#include <boost/unordered/unordered_map.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace bernal {

/// Numbers points in three dimensions by value, with -0 as 0, in order of first occurrence.
template <class Point>
class PointNumbers {
 public:
  std::uint32_t of(const Point& p) {
    const std::array<double, 3> key = {p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // -0.0 + 0.0 is +0.0
    const auto [entry, is_new] = number_.try_emplace(key, static_cast<std::uint32_t>(points.size()));
    if (is_new) points.push_back(p);
    return entry->second;
  }

  std::vector<Point> points;  ///< in order of first occurrence

 private:
  struct HashOfBits {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::uint64_t hash = 0;
      for (const double x : p) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15;
        hash ^= hash >> 32U;
      }
      return hash;
    }
  };

  boost::unordered_map<std::array<double, 3>, std::uint32_t, HashOfBits> number_;
};

/// Maps the corners of triangles by a function of their numbers.
template <class Triangles, class NumberOf>
void renumber(Triangles& triangles, const NumberOf& number_of) {
  for (auto& t : triangles)
    for (auto& v : t) v = number_of(v);
}

}  // namespace bernal
