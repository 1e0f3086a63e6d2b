#pragma once
#include <variant>
#include <vector>

#include "soft/neighbor_relaxation.hpp"
#include "soft/soft_packing.hpp"

namespace bernal {

/// Overlapping spheres that push each other apart in a periodic box, by the engine that is faster there:
/// `SoftPacking` in a box of up to three dimensions that is wide enough for it and has no walls, and
/// `NeighborRelaxation` in any other. Here alone it is chosen. What the calls do stands there.
template <int D>
class SoftEngine {
 public:
  /// Centres in [0, edge). The box may become smaller than it is by the factor `room` later on. Axes with
  /// `walls` (empty: none) keep centres `share` times their radius away from both ends.
  SoftEngine(const Spheres<D>& spheres, const Vector<D>& edges, double room = 1,
             const std::vector<bool>& walls = {}, double share = 1);

  /// Whether the box is wide enough for the sorted arrays of `SoftPacking`, whose lists know sizes.
  static bool is_wide(const Spheres<D>& spheres, const Vector<D>& edges, double room = 1);

  void wear_lists(double wear);
  void sweep(float omega);
  double sweep_and_measure(float omega);
  std::vector<float> squeeze() const;
  void grow(double factor);
  void write_to(Spheres<D>& spheres, Vector<D>& edges) const;
  std::uint64_t builds() const;

 private:
  // In more than three dimensions there is but one kind.
  using Engine = std::conditional_t<D <= 3, std::variant<NeighborRelaxation<D>, SoftPacking>,
                                    std::variant<NeighborRelaxation<D>>>;

  static Engine make(const Spheres<D>& spheres, const Vector<D>& edges, bool wide);

  Engine engine_;
};

}  // namespace bernal
