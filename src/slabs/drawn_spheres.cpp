#include "slabs/drawn_spheres.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "core/parallel.hpp"

namespace bernal {
namespace {

constexpr std::uint64_t between_looks = 1 << 16;

}  // namespace

void DrawnSpheres::for_each_radius(double unit, const std::function<void(double)>& visit) const {
  RadiusSequence radii(*plan.radii, seed, *plan.scene.draw);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (i % between_looks == 0) throw_if_interrupted();
    visit(radii.next() / unit);
  }
}

DrawnSpheres::Sizes DrawnSpheres::sizes() const {
  Sizes sizes{.least = std::numeric_limits<double>::infinity()};
  for_each_radius(1, [&](double r) {
    sizes.least = std::min(sizes.least, r);
    sizes.largest = std::max(sizes.largest, r);
    sizes.mean += r;
    sizes.volume += ball_volume(3, r);
  });
  sizes.mean /= static_cast<double>(count);
  return sizes;
}

engine::TaskSpheres::Tell DrawnSpheres::in_box(const Vector<3>& edges, double unit) const {
  return [this, edges, unit](const engine::TaskSpheres::Visit& visit) {
    Random places(seed, stream(Stream::insert, 0));
    for_each_radius(unit, [&](double r) { visit(uniform_point<3>(places, {Vector<3>::Zero(), edges}), r); });
  };
}

void RadiiByNumber::add(std::uint64_t number, double r) {
  // The finaliser of splitmix64 (Steele, Lea & Flood 2014), of both together.
  const auto mixed = [](std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
    return x ^ (x >> 31);
  };
  sum_ += mixed(mixed(number + 0x9E3779B97F4A7C15) ^ std::bit_cast<std::uint64_t>(r));
}

}  // namespace bernal
