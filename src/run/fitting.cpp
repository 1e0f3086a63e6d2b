#include "run/fitting.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/random.hpp"
#include "domain/places.hpp"
#include "work/bed.hpp"

namespace bernal {
namespace {

struct LargestRadius {
  double operator()(const Box& b) const { return 0.5 * b.size.minCoeff(); }
  double operator()(const Cylinder& c) const { return std::min(c.radius, 0.5 * c.height); }
  double operator()(const Sphere& s) const { return s.radius; }
  double operator()(const Mesh& m) const {
    const double by_volume = std::cbrt(3 * volume_of(m) / (4 * std::numbers::pi));
    return std::min(0.5 * bounds_of(m).size().minCoeff(), by_volume);
  }
};

}  // namespace

void require_long_periods(const Scene& scene, const Domain& container, double radius) {
  const Boundary<3> boundary = boundary_of<3>(container);
  for (int k = 0; k < 3; ++k) {
    const double least = Bed::least_period * 2 * radius;
    if (!boundary.repeats(k) || boundary.edges[k] >= least) continue;
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the container repeats itself every {:.6g} {}, in which spheres meet two images of "
                    "others; for these sizes make that at least {:.6g} {}",
                    boundary.edges[k], name_of(scene.unit), least, name_of(scene.unit)),
        scene.container.locations.whole);
  }
}

double largest_fitting_radius(const Domain& shape) { return std::visit(LargestRadius{}, shape); }

void require_fitting(const Scene& scene, const Domain& container, double radius) {
  const double largest = largest_fitting_radius(container);
  if (radius <= largest) return;
  const double shown = scene.sizes_are_diameters ? 2 : 1;
  const auto [one, many] =
      scene.sizes_are_diameters ? std::pair("diameter", "diameters") : std::pair("radius", "radii");
  throw Error(
      ErrorCode::bad_scene,
      fmt::format("a sphere of {} {:.6g} {} does not fit into the {}, which takes {} up to {:.6g} {}: use "
                  "smaller ones or check the units",
                  one, shown * radius, name_of(scene.unit), kind_of(container), many, shown * largest,
                  name_of(scene.unit)),
      scene.sizes.locations.whole);
}

void refuse_thin_container() {
  throw Error(ErrorCode::bad_argument,
              "the container is so thin, and so oblique to the axes, that random places in it are not to be "
              "found: turn it so that its length lies along an axis");
}

double radius_with_hardly_any_room(const Container& container, std::uint64_t seed) {
  constexpr std::size_t points = 10000;
  Random random(seed, stream(Stream::room));
  const Bounds<3> bounds = container.bounds();
  std::vector<double> clearances;
  for (const Vector<3>& p :
       points_inside(container, points, seed, [&](std::size_t) { return uniform_point(random, bounds); }))
    clearances.push_back(container.clearance(p));
  if (clearances.empty()) refuse_thin_container();
  const auto hundredth = clearances.begin() + static_cast<std::ptrdiff_t>(clearances.size() / 100);
  std::nth_element(clearances.begin(), hundredth, clearances.end(), std::greater<>());
  return *hundredth;
}

}  // namespace bernal
