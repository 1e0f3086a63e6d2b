#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "soft/soft_packing.hpp"
#include "work/places.hpp"

namespace bernal {

/// What a `Crowd` stands on in a container: its walls push, and holes have to clear them.
class ContainerGround {
 public:
  static constexpr int dimension = 3;
  /// Of the radii, in a burst.
  static constexpr double burst_swelling = 1.02;
  /// So many spheres are never moved to holes, however squeezed they are.
  static constexpr std::size_t always_stay = 0;

  /// Both outlive this.
  ContainerGround(const Container& container, const Places& places)
      : container_(&container), places_(&places) {}

  /// Puts the spheres, whose centres are inside the container, into the engine. Throws Error{bad_scene} where
  /// single precision cannot tell them apart: in a container 100,000 times as large as they are.
  void place(const Spheres<3>& spheres);
  void read_places(Spheres<3>& spheres) const { packing_->write_to(spheres); }

  void sweep(float omega) { packing_->sweep(omega); }
  double sweep_and_measure(float omega) { return packing_->sweep_and_measure(omega); }
  void wear_lists(double wear) { packing_->wear_lists(wear); }
  std::vector<float> squeeze() const { return packing_->squeeze(); }
  /// Radii become so many times those that are relaxed.
  void swell(double factor) { packing_->swell((1 + margin_) * factor); }
  /// Share of the radii; it takes three times as much off the packing fraction.
  double margin() const { return margin_; }

  /// Puts the spheres `ids` into the largest holes where they clear the wall, the largest first.
  void move_to_holes(Spheres<3>& spheres, std::vector<std::uint32_t> ids, Random& random);
  /// Places for spheres of these radii, which descend; fewer if there are not so many.
  std::vector<Vector<3>> holes_for(std::span<const double> radii, const Spheres<3>& spheres,
                                   Random& random) const;

  std::uint64_t list_builds() const { return list_builds_ + packing_->builds(); }
  std::uint64_t wall_queries() const { return wall_queries_ + packing_->wall_queries(); }

 private:
  const Container* container_;
  const Places* places_;
  std::unique_ptr<SoftPacking> packing_;
  double margin_ = 0;
  std::uint64_t list_builds_ = 0, wall_queries_ = 0;
};

}  // namespace bernal
