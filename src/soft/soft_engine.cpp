#include "soft/soft_engine.hpp"

#include "core/every_dimension.hpp"

namespace bernal {

template <int D>
SoftEngine<D>::SoftEngine(const Spheres<D>& spheres, const Vector<D>& edges, double room,
                          const std::vector<bool>& walls, double share)
    : engine_(make(spheres, edges, is_wide(spheres, edges, room) && walls.empty())) {
  if (!walls.empty()) std::get<NeighborRelaxation<D>>(engine_).keep_between_walls(walls, share);
}

template <int D>
bool SoftEngine<D>::is_wide(const Spheres<D>& spheres, const Vector<D>& edges, double room) {
  return D <= 3 && edges.minCoeff() >= room * SoftPacking::smallest_edge(spheres.r);
}

template <int D>
void SoftEngine<D>::wear_lists(double wear) {
  std::visit([&](auto& engine) { engine.wear_lists(wear); }, engine_);
}

template <int D>
void SoftEngine<D>::sweep(float omega) {
  std::visit([&](auto& engine) { engine.sweep(omega); }, engine_);
}

template <int D>
double SoftEngine<D>::sweep_and_measure(float omega) {
  return std::visit([&](auto& engine) { return engine.sweep_and_measure(omega); }, engine_);
}

template <int D>
std::vector<float> SoftEngine<D>::squeeze() const {
  return std::visit([](const auto& engine) { return engine.squeeze(); }, engine_);
}

template <int D>
void SoftEngine<D>::grow(double factor) {
  std::visit([&](auto& engine) { engine.grow(factor); }, engine_);
}

template <int D>
void SoftEngine<D>::write_to(Spheres<D>& spheres, Vector<D>& edges) const {
  std::visit([&](const auto& engine) { engine.write_to(spheres, edges); }, engine_);
}

template <int D>
std::uint64_t SoftEngine<D>::builds() const {
  return std::visit([](const auto& engine) { return engine.builds(); }, engine_);
}

template <int D>
typename SoftEngine<D>::Engine SoftEngine<D>::make(const Spheres<D>& spheres, const Vector<D>& edges,
                                                   bool wide) {
  if constexpr (D <= 3) {
    if (wide) return Engine(std::in_place_type<SoftPacking>, spheres, edges, soft_kernels().front());
  }
  return Engine(std::in_place_type<NeighborRelaxation<D>>, spheres, edges);
}

#define BERNAL_INSTANTIATE(D) template class SoftEngine<D>;
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal
