#include "stages/relax.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "stages/relax_reference.hpp"

namespace bernal {
namespace {

double volume_of_spheres(const PeriodicWork& work) {
  double sum = 0;
  for (const double r : work.spheres.r) sum += ball_volume(work.dimension(), r);
  return sum;
}

void set_volume(PeriodicWork& work, double volume) {
  work.edges *= std::pow(volume / work.edges.prod(), 1.0 / work.dimension());
}

}  // namespace

StageEnd relax(PeriodicWork& work, const RelaxOptions& options) {
  EffectTimer timer(work.effects["relaxation"]);
  set_volume(work, volume_of_spheres(work) / options.phi0);
  return with_dimension(work.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    return relax_by_the_book<D>(work, options);
  });
}

}  // namespace bernal
