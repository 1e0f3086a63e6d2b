#pragma once
#include <algorithm>
#include <array>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_map.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// Points by number in a sparse grid of cubes of a given edge; only cubes with points are stored.
class PointCubes {
 public:
  explicit PointCubes(double edge) : edge_(edge) {}

  void add(std::uint32_t number, const Vector<3>& p) { cubes_[cube_of(p)].push_back(number); }

  /// Calls see(number) for every point in the cubes that the bounds meet. Cost: the number of these cubes, or
  /// of all cubes with points if that is smaller.
  template <class See>
  void each_in(const Vector<3>& lower, const Vector<3>& upper, const See& see) const {
    const Cube from = cube_of(lower), to = cube_of(upper);
    const auto is_between = [&](const Cube& c) {
      for (std::size_t k = 0; k < 3; ++k)
        if (c[k] < from[k] || c[k] > to[k]) return false;
      return true;
    };
    double count = 1;
    for (std::size_t k = 0; k < 3; ++k) count *= to[k] - from[k] + 1;
    if (count > static_cast<double>(cubes_.size())) {
      for (const auto& [cube, numbers] : cubes_)
        if (is_between(cube)) std::ranges::for_each(numbers, see);
      return;
    }
    Cube c;
    for (c[0] = from[0]; c[0] <= to[0]; ++c[0])
      for (c[1] = from[1]; c[1] <= to[1]; ++c[1])
        for (c[2] = from[2]; c[2] <= to[2]; ++c[2])
          if (const auto found = cubes_.find(c); found != cubes_.end())
            std::ranges::for_each(found->second, see);
  }

 private:
  using Cube = std::array<double, 3>;  // integers of any size

  Cube cube_of(const Vector<3>& p) const {
    Cube c;
    for (int k = 0; k < 3; ++k) c[static_cast<std::size_t>(k)] = std::floor(p[k] / edge_) + 0.0;
    return c;
  }

  double edge_;
  boost::unordered_map<Cube, std::vector<std::uint32_t>> cubes_;
};

}  // namespace bernal::cad
