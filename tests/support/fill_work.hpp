#pragma once
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "fly/fill_by_classes.hpp"

namespace bernal::testing {

/// Radii and the box that they are to fill, without a scene; and what is needed to run a stage on them.
struct FillCase {
  EffectLog effects;
  Monitor monitor;
  Task task;
  SpheresInBox in_box;
  Reporter report;

  FillCase(std::vector<double> radii, const Vector<dynamic>& target, std::uint64_t seed = 1)
      : task{.target_edges = target},
        in_box{.task = task, .spheres = Spheres<dynamic>(static_cast<int>(target.size())), .edges = target},
        report{.seed = seed, .monitor = monitor, .effects = effects} {
    in_box.spheres.resize(radii.size());
    in_box.spheres.r = std::move(radii);
    in_box.tags.resize(in_box.spheres.size());
    std::iota(in_box.tags.begin(), in_box.tags.end(), 0u);
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
