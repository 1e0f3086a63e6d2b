#pragma once
#include <cmath>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "fly/fill_by_classes.hpp"

namespace bernal::testing {

/// Radii and the box that they are to fill, without a scene; and what is needed to run a stage on them.
struct FillCase {
  EffectLog effects;
  Monitor monitor;
  Work work;

  FillCase(std::vector<double> radii, const Vector<dynamic>& target, std::uint64_t seed = 1)
      : work{.spheres = Spheres<dynamic>(static_cast<int>(target.size())),
             .edges = target,
             .target_edges = target,
             .seed = seed,
             .monitor = monitor,
             .effects = effects} {
    for (auto& column : work.spheres.x) column.assign(radii.size(), 0);
    work.spheres.r = std::move(radii);
  }
  FillCase(const FillCase&) = delete;
  FillCase& operator=(const FillCase&) = delete;
};

/// Edges in these proportions, of the box that the spheres fill to `packing_fraction`.
inline Vector<dynamic> box_filled_to(double packing_fraction, const std::vector<double>& radii,
                                     const Vector<dynamic>& proportions) {
  const auto dimension = static_cast<int>(proportions.size());
  double volume = 0;
  for (const double r : radii) volume += ball_volume(dimension, r);
  return proportions * std::pow(volume / packing_fraction / proportions.prod(), 1.0 / dimension);
}
inline Vector<dynamic> cube_filled_to(double packing_fraction, const std::vector<double>& radii,
                                      int dimension) {
  return box_filled_to(packing_fraction, radii, Vector<dynamic>::Ones(dimension));
}

/// `count` radii of three classes with the ratios 10 : 4 : 1, of which each fills its share .6, .25, .15 of
/// their volume, in an order that mixes them.
inline std::vector<double> three_classes(std::size_t count) {
  const double shares[] = {0.6 / 1000, 0.25 / 64, 0.15}, all = shares[0] + shares[1] + shares[2];
  const auto n = static_cast<double>(count);
  const auto large = static_cast<std::size_t>(std::lround(n * shares[0] / all)),
             middle = static_cast<std::size_t>(std::lround(n * shares[1] / all));
  std::vector<double> radii(count);
  for (std::size_t i = 0; i < count; ++i)
    radii[i * 7919 % count] = i < large ? 1.0 : i < large + middle ? 0.4 : 0.1;
  return radii;
}

}  // namespace bernal::testing
