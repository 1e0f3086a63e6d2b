#include "cost/bench_rooms.hpp"

#include <cmath>
#include <numbers>

#include "bernal/predict/predict.hpp"
#include "bernal/run/run.hpp"

namespace bernal::cost {
namespace {

constexpr int rods_to_predict = 16000;

Scene scene_of(const SizeClass& sizes) {
  Scene scene;
  scene.sizes = sizes.sizes;
  scene.sizes_are_diameters = true;
  scene.draw = Draw::quantiles;
  return scene;
}

}  // namespace

SizeClass equal_sizes() { return {"equal", "equal spheres", Constant{1}, false, 2000, 100}; }

SizeClass lognormal_sizes() {
  return {"lognormal",
          "lognormal spheres, sigma 0.3",
          Lognormal{.median = 1, .sigma = 0.3, .max = 3},
          false,
          2000,
          700};
}

SizeClass one_to_five() {
  return {"1_5",
          "diameters 1 : 5, a fifth of the volume small",
          Classes{.values = {1, 5}, .shares = {1, 4}, .basis = Basis::volume},
          true,
          3000,
          1200};
}

Scene room_for(const SizeClass& sizes, std::int64_t count, Sides sides, double packing_fraction) {
  Scene scene = scene_of(sizes);
  if (sides == Sides::none) {
    scene.container = PeriodicBox{};
    scene.target.count = count;
    return scene;
  }
  const double volume = static_cast<double>(count) * 4 / 3 * std::numbers::pi * radii_of(scene)->moment(3);
  const double edge = std::cbrt(volume / packing_fraction);
  if (sides == Sides::lids)
    scene.container = PeriodicBox{.edge = edge, .walls = {2}};
  else
    scene.container = Box{.corner = Vector<3>::Zero(), .size = Vector<3>::Constant(edge)};
  return scene;
}

double predicted_for(const SizeClass& sizes) {
  return predict_packing_fraction(*radii_of(scene_of(sizes)), rods_to_predict).phi;
}

}  // namespace bernal::cost
