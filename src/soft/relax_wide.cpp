#include "soft/relax_wide.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "soft/from_largest.hpp"
#include "work/free_of_overlap.hpp"
#include "work/random_insertion.hpp"

namespace bernal {
namespace {

/// A box of given edges, as `place_kinds` knows one.
template <int D>
class KindsInBox {
 public:
  KindsInBox(const Vector<D>& edges, const std::vector<bool>& walls)
      : edges_(edges), walls_(walls), boundary_(boundary_of<D>(periodic_box(edges, walls))) {}

  const Boundary<D>& boundary() const { return boundary_; }
  Bounds<D> bounds() const { return {Vector<D>::Zero(), edges_}; }
  /// A random place, between the walls for a sphere of this radius.
  Vector<D> any_place(double r, Random& random, const Monitor&) const { return place(r, random); }
  std::optional<Vector<D>> trial(double r, Random& random) const { return place(r, random); }
  SoftPacking engine(const Spheres<D>& spheres) const {
    SoftPacking packing(spheres, edges_, soft_kernels().front(), true);
    packing.keep_between_walls(walls_, 1);
    return packing;
  }
  /// In a box of their own, which is then scaled to this one.
  StageEnd pack(Spheres<D>& spheres, const GrowingBox& growing, BoxGrowth& growth, double& dense,
                Random& random, Reporter& report) const {
    double factor = std::pow(volume_of(spheres) / (start_of_few * edges_.prod()), 1.0 / D);
    factor = std::max(factor, 2.0001 * std::ranges::max(spheres.r) / edges_.minCoeff());
    Vector<D> box = factor * edges_;
    const KindsInBox start(box, walls_);
    place_between(spheres, 0, start, random, report.monitor);
    SoftPacking packing = start.engine(spheres);
    const StageEnd end = grow_apart<D>(
        packing, growing, growth, [&] { return report.monitor.stop(); }, overlap_by_means<D>(spheres.r),
        [](double, double) {});
    count_growth(report, packing, growth, growing, end);
    packing.write_to(spheres, box);
    dense = 1 / box.prod();
    resize_box<D>(spheres, box, edges_);
    return end;
  }

 private:
  Vector<D> place(double r, Random& random) const {
    Bounds<D> box = bounds();
    for (int k = 0; k < D; ++k) {
      if (boundary_.repeats(k)) continue;
      const double off = std::min(r, 0.5 * edges_[k]);
      box.lower[k] += off;
      box.upper[k] -= off;
    }
    return uniform_point(random, box);
  }

  Vector<D> edges_;
  std::vector<bool> walls_;
  Boundary<D> boundary_;
};

}  // namespace

bool is_for_wide_sizes(const FillTask& task, const Relax& options) {
  return (task.dimension == 2 || task.dimension == 3) && !task.is_tilted &&
         options.method == RelaxMethod::fast && !(task.width_of_sizes < wide_sizes_from);
}

template <int D>
StageEnd place_from_largest(Spheres<D>& spheres, const Vector<D>& edges, const SpheresInBox& in_box,
                            Reporter& report, const Relax& options) {
  Random random = report.random(Stream::relax);
  return place_kinds<D>(spheres, KindsInBox<D>(edges, in_box.task.walls), report, options, random,
                        [&](double largest, double done) {
                          report.milestone("relax", in_box, largest, share_of_placing * done);
                        });
}

template <int D>
StageEnd relax_wide(Spheres<D>& spheres, Vector<D>& edges, SpheresInBox& in_box, Reporter& report,
                    const Relax& options, double overlap, double before) {
  SoftPacking packing = KindsInBox<D>(edges, in_box.task.walls).engine(spheres);
  const GrowingBox box =
      box_of_wide(options, spheres.size(), least_overlap(options, in_box.task.allowed_overlap));
  return let_box_grow<D>(packing, spheres, edges, in_box, report, box, {.molr = overlap}, before,
                         overlap_by_means<D>(spheres.r));
}

#define BERNAL_INSTANTIATE(D)                                                                           \
  template StageEnd place_from_largest(Spheres<D>&, const Vector<D>&, const SpheresInBox&, Reporter&,   \
                                       const Relax&);                                                   \
  template StageEnd relax_wide(Spheres<D>&, Vector<D>&, SpheresInBox&, Reporter&, const Relax&, double, \
                               double);
BERNAL_INSTANTIATE(2)
BERNAL_INSTANTIATE(3)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
