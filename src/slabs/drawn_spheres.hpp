#pragma once
#include <cstdint>

#include "bernal/plan/plan.hpp"
#include "engine/engine_task.hpp"

namespace bernal {

/// The spheres of a plan whose count is given, drawn again whenever somebody asks: the same as a `Supply`
/// would hold.
struct DrawnSpheres {
  const Plan& plan;
  std::uint64_t seed;
  std::uint64_t count;

  struct Sizes {
    double least = 0, largest = 0, mean = 0, volume = 0;
  };
  /// In the scene's unit. Asks once.
  Sizes sizes() const;
  /// Radii over a unit, in the order of the sequence.
  void for_each_radius(double unit, const std::function<void(double r)>& visit) const;
  /// With places at random in a box of these edges, in that unit; this outlives what is returned.
  engine::TaskSpheres::Tell in_box(const Vector<3>& edges, double unit) const;
};

/// Which radius each number has, in whatever order they come: equal sums mean, but for one case in 10^19,
/// that all are as they were.
class RadiiByNumber {
 public:
  void add(std::uint64_t number, double r);
  bool operator==(const RadiiByNumber&) const = default;

 private:
  std::uint64_t sum_ = 0;
};

}  // namespace bernal
