#pragma once
#include <array>
#include <boost/functional/hash.hpp>
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
  boost::unordered_map<std::array<double, 3>, std::uint32_t> number_;
};

/// Maps the corners of triangles by a function of their numbers.
template <class Triangles, class NumberOf>
void renumber(Triangles& triangles, const NumberOf& number_of) {
  for (auto& t : triangles)
    for (auto& v : t) v = number_of(v);
}

}  // namespace bernal
