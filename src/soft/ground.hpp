#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"
#include "core/archive.hpp"
#include "domain/places.hpp"
#include "soft/soft_engine.hpp"

namespace bernal {

/// Throws Error{bad_scene} where single precision cannot tell spheres apart in a container: where a unit of
/// its coordinates, 2^-32 of the longest edge, is more than 1e-4 of the smallest radius: that ratio it is
/// given.
void require_resolution(double resolution);

/// What a `Crowd` stands on in a container: its walls push, and holes have to clear them.
class ContainerGround {
 public:
  static constexpr int dimension = 3;
  /// Of the radii, in a burst.
  static constexpr double burst_swelling = 1.02;
  /// So many spheres are never moved to holes, however squeezed they are.
  static constexpr std::size_t always_stay = 0;
  /// Lists may be worn further while spheres are crowded, and as many are put into holes as are stuck.
  static constexpr bool crowds_wear_lists = true;

  /// Both outlive this. Where spheres are `snug`, none having more room between the walls than it takes,
  /// walls press a little less than spheres, so that they leave these free.
  ContainerGround(const Container& container, const Places& places, bool snug = false)
      : container_(&container), places_(&places), snug_(snug) {}

  /// Puts the spheres, whose centres are inside the container, into the engine. Throws what
  /// `require_resolution` does.
  void place(const Spheres<3>& spheres);
  void read_places(Spheres<3>& spheres) const { packing_->write_to(spheres); }

  SoftPacking& engine() { return *packing_; }
  /// Radii become so many times those that are relaxed.
  void swell(double factor) { packing_->swell((1 + margin_) * factor); }
  /// Share of the radii; it takes D times as much off the packing fraction.
  double margin() const { return margin_; }

  /// Puts the spheres `ids` into the largest holes where they clear the wall, the largest first.
  void move_to_holes(Spheres<3>& spheres, std::vector<std::uint32_t> ids, Random& random);
  /// Places for spheres of these radii, which descend; fewer if there are not so many.
  std::vector<Vector<3>> holes_for(std::span<const double> radii, const Spheres<3>& spheres,
                                   Random& random) const;

  Effect lists_built() const { return lists_built_ + packing_->lists_built(); }

  /// Of as many spheres as were placed.
  void archive(Archive& a) { a(margin_, lists_built_, *packing_); }

 private:
  const Container* container_;
  const Places* places_;
  bool snug_;
  std::unique_ptr<SoftPacking> packing_;
  double margin_ = 0;
  Effect lists_built_;
};

/// What a `Crowd` stands on in a box of 1 to 8 dimensions that repeats itself along all axes or along those
/// without walls. What matters is how distances compare with radii: where spheres are to be larger, the box
/// is smaller.
template <int D>
class BoxGround {
 public:
  static constexpr int dimension = D;
  /// Of the radii, in a burst. Where there are more dimensions to give way in, more helps faster: N = 2,000,
  /// in five dimensions at 0.302 and six at 0.197, 0.4 s and 0.85 s instead of 0.85 s and 1.3 s.
  static constexpr double burst_swelling = D <= 4 ? 1.02 : 1.04;
  static constexpr std::size_t always_stay = 1;
  static constexpr bool crowds_wear_lists = false;

  /// Every edge is at least the largest diameter less what overlap is allowed: the spheres are relaxed with
  /// the share 1 - `allowed` of their radii. Axes with `walls` keep whole spheres between them; none: empty.
  BoxGround(const Vector<D>& edges, double allowed, std::vector<bool> walls = {})
      : edges_(edges), allowed_(allowed), walls_(std::move(walls)) {}

  /// Puts the spheres, with centres in [0, edge), into the engine.
  void place(const Spheres<D>& spheres);
  void read_places(Spheres<D>& spheres) const;

  SoftEngine<D>& engine() { return *engine_; }
  void swell(double factor) { engine_->grow(factor == 1 ? burst_swelling : 1 / factor); }
  double margin() const { return margin_; }

  /// Puts the spheres `ids` into the largest holes, the largest first.
  void move_to_holes(Spheres<D>& spheres, std::vector<std::uint32_t> ids, Random& random);

  Effect lists_built() const { return lists_built_ + engine_->lists_built(); }

  /// Of as many spheres as were placed.
  void archive(Archive& a) { a(margin_, lists_built_, *engine_); }

 private:
  Vector<D> edges_;
  double allowed_;
  std::vector<bool> walls_;
  double margin_ = 0;
  std::optional<SoftEngine<D>> engine_;
  Effect lists_built_;
};

}  // namespace bernal
