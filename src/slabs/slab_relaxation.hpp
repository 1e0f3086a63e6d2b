#pragma once
#include <functional>

#include "bernal/scene/packing.hpp"
#include "slabs/slab_store.hpp"

namespace bernal {

/// Overlapping spheres that push each other apart in a periodic box, slab by slab: what `grow_apart` works
/// on. A visit takes a slab into memory with those around it that may come near, sweeps its own while the
/// others rest, and puts them back; every second slab is visited first, then the others. So a sweep is not
/// one of all spheres, but so many of one slab: overlaps are pushed about within slabs, which matters where
/// they have far to go, and hardly where an engine has left them at 1e-3.
///
/// All this is a function of the places and radii alone, the same for any number of threads. Memory: about
/// 190 bytes for each sphere of a slab and of what lies within some radii of it. Cost: that of the sweeps of
/// `SoftPacking`, and about 1 µs a sphere and visit.
class SlabPacking {
 public:
  /// Centres in the store, whose spheres are up to `largest` and in the mean `mean` large; `look` is called
  /// before each visit, and may throw. Preconditions: as `thinnest_slab` and `narrowest_box` say.
  SlabPacking(SlabStore& store, const Vector<3>& edges, double largest, double mean,
              std::function<void()> look);

  /// The least thickness of slabs, and the least edge of the box along other axes, over the largest radius.
  static constexpr double thinnest_slab = 8, narrowest_box = 6;

  void wear_lists(double wear) { wear_ = wear; }
  void sweep(float omega);
  double sweep_to_overlap(float omega);
  void grow(double factor) { edges_ *= factor; }

  const Vector<3>& edges() const { return edges_; }
  const Effect& lists_built() const { return lists_built_; }

 private:
  double visit_all(bool measure);
  double visit(int slab, int sweeps, bool measure);

  SlabStore& store_;
  Vector<3> edges_;
  double width_;  // around a slab, of what its spheres may come near to
  std::function<void()> look_;
  double wear_ = 0.9;
  float omega_ = 1;
  int due_ = 0;  // sweeps
  Effect lists_built_{"neighbour lists", 0, 0};
};

/// The smallest factor, to rounding, by which the box has to grow so that no two spheres overlap: see
/// `contact_factor`; not less than 0.8. Slab by slab, `look` as of SlabPacking.
double contact_factor_of(const SlabStore& store, const Vector<3>& edges, double largest,
                         const std::function<void()>& look);

}  // namespace bernal
