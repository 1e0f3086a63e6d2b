#include "soft/relax_fast.hpp"

#include <algorithm>
#include <cmath>

#include "core/every_dimension.hpp"
#include "soft/soft_engine.hpp"

namespace bernal {
namespace {

/// Where the overlap falls linearly with the growth of the box. Earlier, prediction costs contacts.
constexpr double predictable = 3e-3;
constexpr double share_of_prediction = 0.9;
constexpr double longest_predicted = 1.0 / 6;
/// From so many spheres on more sweeps a growth are not needed for the packing fraction to stay what it is.
constexpr std::size_t enough = 10000;
/// What is left of `stop`: a few more growths are cheap, and the packing fraction that the exact growth of
/// the box at the end takes away is three times the overlap that is left.
constexpr double share_of_stop = 0.05;
/// Single precision shows no less.
constexpr double least_overlap = 4e-6;

/// How much the box grows, by the largest overlap before and after its last growth.
class Growth {
 public:
  explicit Growth(double beta) : beta_(beta) {}

  /// The factor less 1.
  double next(double molr) {
    double growth = molr / beta_;
    if (molr < predictable && molr < last_molr_) {
      const double predicted = last_growth_ * molr / (last_molr_ - molr);
      growth = std::max(growth, std::min(share_of_prediction * predicted, longest_predicted * molr));
    }
    last_molr_ = molr;
    last_growth_ = growth;
    return growth;
  }

 private:
  double beta_;
  double last_molr_ = 0;
  double last_growth_ = 0;
};

}  // namespace

template <int D>
StageEnd relax_fast(Spheres<D>& spheres, Vector<D>& edges, Work& work, const RelaxOptions& options) {
  SoftEngine<D> packing(spheres, edges, 1, work.walls);
  const int sweeps = sweeps_a_cycle(options.alpha, std::min(spheres.size(), enough));
  const double stop =
      std::max({share_of_stop * options.stop, std::min(work.allowed_overlap, options.stop), least_overlap});
  Growth growth(options.beta);
  StageEnd end = StageEnd::converged;
  for (double molr = 1;;) {
    const Pace pace = pace_for(molr);
    packing.wear_lists(pace.wear);
    const float omega = pace.omega * D / 3;
    for (int k = 1; k < sweeps && end == StageEnd::converged; ++k) {
      packing.sweep(omega);
      if (work.monitor.stop()) end = StageEnd::cancelled;
    }
    molr = packing.sweep_and_measure(omega);
    if (end == StageEnd::cancelled || molr < stop) break;
    const double factor = 1 + growth.next(molr);
    packing.grow(factor);
    work.edges *= factor;
    work.milestone("relax", std::min(0.99, std::log(molr) / std::log(stop)), molr);
  }
  Effect& lists = work.effects["neighbour lists"];
  lists.calls += packing.builds();
  packing.write_to(spheres, edges);
  return end;
}

template <int D>
bool fast_path_exists(const Spheres<D>& spheres, const Vector<D>& edges) {
  return D > 3 || SoftEngine<D>::is_wide(spheres, edges);
}

#define BERNAL_INSTANTIATE(D)                                             \
  template bool fast_path_exists<D>(const Spheres<D>&, const Vector<D>&); \
  template StageEnd relax_fast<D>(Spheres<D>&, Vector<D>&, Work&, const RelaxOptions&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
