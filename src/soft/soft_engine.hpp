#pragma once
#include <type_traits>
#include <variant>
#include <vector>

#include "core/archive.hpp"
#include "soft/neighbor_relaxation.hpp"
#include "soft/soft_packing.hpp"

namespace bernal {

/// Overlapping spheres that push each other apart in a periodic box of 1 to 8 dimensions. The engine is
/// `SoftPacking` in up to three dimensions, and `NeighborRelaxation` in more or in a tilted box. Their
/// headers say what the calls do.
template <int D>
class SoftEngine {
 public:
  /// Centres in [0, edge). Along axes with `walls` (empty: none) centres keep `share` times their radius away
  /// from both ends. `by_octaves` as of `SoftLists`; only `SoftPacking` knows it. A `tilt` is that of a box
  /// without walls. Precondition: every edge, and the shortest period, is at least the largest diameter.
  SoftEngine(const Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls = {},
             double share = 1, bool by_octaves = false, const Tilt& tilt = {})
      : engine_(make(spheres, edges, by_octaves, tilt)) {
    if (!walls.empty()) std::visit([&](auto& engine) { engine.keep_between_walls(walls, share); }, engine_);
  }

  void wear_lists(double wear) {
    std::visit([&](auto& engine) { engine.wear_lists(wear); }, engine_);
  }
  void sweep(float omega) {
    std::visit([&](auto& engine) { engine.sweep(omega); }, engine_);
  }
  double sweep_and_measure(float omega) {
    return std::visit([&](auto& engine) { return engine.sweep_and_measure(omega); }, engine_);
  }
  double sweep_to_overlap(float omega) {
    return std::visit([&](auto& engine) { return engine.sweep_to_overlap(omega); }, engine_);
  }
  std::vector<float> squeeze() const {
    return std::visit([](const auto& engine) { return engine.squeeze(); }, engine_);
  }
  std::vector<float> forces() const {
    return std::visit([](const auto& engine) { return engine.forces(); }, engine_);
  }
  void exchange(const std::vector<std::uint32_t>& to) {
    std::visit([&](auto& engine) { engine.exchange(to); }, engine_);
  }
  void resize(const std::vector<float>& radii) {
    std::visit([&](auto& engine) { engine.resize(radii); }, engine_);
  }
  void grow(double factor) {
    std::visit([&](auto& engine) { engine.grow(factor); }, engine_);
  }
  void write_to(Spheres<D>& spheres, Vector<D>& edges) const {
    std::visit([&](const auto& engine) { engine.write_to(spheres, edges); }, engine_);
  }
  const Effect& lists_built() const {
    return std::visit([](const auto& engine) -> const Effect& { return engine.lists_built(); }, engine_);
  }
  void archive(Archive& a) {
    std::visit([&](auto& engine) { engine.archive(a); }, engine_);
  }

 private:
  static constexpr bool knows_tilt = D == 2 || D == 3;
  using Engine =
      std::conditional_t<knows_tilt, std::variant<SoftPacking, NeighborRelaxation<D, knows_tilt>>,
                         std::variant<std::conditional_t<D <= 3, SoftPacking, NeighborRelaxation<D>>>>;

  static Engine make(const Spheres<D>& spheres, const Vector<D>& edges, bool by_octaves, const Tilt& tilt) {
    if constexpr (knows_tilt)
      if (tilt != Tilt{})
        return Engine(std::in_place_type<NeighborRelaxation<D, true>>, spheres, edges, tilt);
    if constexpr (D <= 3)
      return Engine(std::in_place_type<SoftPacking>, spheres, edges, soft_kernels().front(), by_octaves);
    else
      return Engine(std::in_place_type<NeighborRelaxation<D>>, spheres, edges);
  }

  Engine engine_;
};

}  // namespace bernal
