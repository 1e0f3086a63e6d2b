#pragma once
#include <cstdint>
#include <limits>
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

/// `resolution` is a unit of the coordinates, 2^-32 of the longest edge, in smallest radii. Throws
/// Error{bad_scene} if it is more than 1e-4: then single precision cannot tell the spheres apart.
void require_resolution(double resolution);

/// How a crowd is swept and stirred.
struct SweepPolicy {
  float omega;          ///< over-relaxation; 0: that of `pace_for`
  int most_slow_looks;  ///< after so many in a row spheres are stuck:
  double hardly_freer;  ///< at each the mean squeeze is more than this share of its least value
  /// From this mean squeeze on a burst helps most spheres, also where some are squeezed severely.
  double crowded_everywhere;

  float omega_at(const Pace& pace) const { return omega > 0 ? omega : pace.omega; }
};
/// For spheres that are to be as dense as they can.
inline constexpr SweepPolicy patient = {0, 2, 0.85, std::numeric_limits<double>::infinity()};
/// Spheres that have room need not come to rest with all of their contacts: they are agitated all the time,
/// and stirred as soon as the mean squeeze does not fall fast. With the wide margin N = 100,000 in two CAD
/// parts take 900 and 1,400 sweeps in place of 1,600 and 2,400. Where there is none, 1 % fewer spheres fit.
inline constexpr SweepPolicy brisk = {5.7f, 1, 0.75, 0.01};

/// The ground of a `Crowd` in a container: its walls push, and spheres in holes do not overlap them.
class ContainerGround {
 public:
  static constexpr int dimension = 3;
  /// The factor of the radii in a burst.
  static constexpr double burst_swelling = 1.02;
  /// At least this number of spheres is not moved to holes.
  static constexpr std::size_t always_stay = 0;
  /// Whether lists may be worn further while spheres are crowded; then as many spheres are put into holes as
  /// are stuck.
  static constexpr bool crowds_wear_lists = true;
  /// Brisk where the margin is wide.
  const SweepPolicy& policy() const { return first_margin_ > 0 ? brisk : patient; }
  /// The margin while there is room for it. With 1e-3 there are a tenth fewer contacts at a gap of 0.002.
  static constexpr double wide_margin = 5e-4;

  /// Along how many axes spheres move: discs stay in the plane z = 0, where nothing pushes them out of it.
  int axes() const { return container_->dimension(); }

  /// Both outlive this. `snug` says that no sphere has more room between the walls than it takes. Then walls
  /// push a little less than spheres do, so that spheres come free of overlap. `by_octaves` as of
  /// `SoftLists`. The margin is at first as wide as `margin`, at most 0.02, if that is wider than it
  /// has to be.
  ContainerGround(const Container& container, const Places& places, bool snug = false,
                  bool by_octaves = false, double margin = 0)
      : container_(&container),
        places_(&places),
        snug_(snug),
        by_octaves_(by_octaves),
        first_margin_(margin) {}

  /// Puts the spheres, whose centres are inside the container, into the engine. Throws what
  /// `require_resolution` does.
  void place(const Spheres<3>& spheres);
  void read_places(Spheres<3>& spheres) const { packing_->write_to(spheres); }

  SoftPacking& engine() { return *packing_; }
  /// Makes the radii `factor` times those that are relaxed.
  void swell(double factor) { packing_->swell((1 + margin_) * factor); }
  /// By which share of the radii the relaxed spheres are larger than those asked for. It lowers the packing
  /// fraction by D times as much.
  double margin() const { return margin_; }
  /// Halves the margin. Returns false, and does nothing, if it is as narrow as single precision allows.
  bool narrow_margin();

  /// Puts the spheres `ids`, the largest first, into the largest holes in which they do not overlap a wall.
  void move_to_holes(Spheres<3>& spheres, std::vector<std::uint32_t> ids, Random& random);
  /// Places for spheres of these descending radii; fewer if there are not enough holes.
  std::vector<Vector<3>> holes_for(std::span<const double> radii, const Spheres<3>& spheres,
                                   Random& random) const;

  Effect lists_built() const { return lists_built_ + packing_->lists_built(); }

  /// Writes or reads the state. Precondition: the same number of spheres was placed.
  void archive(Archive& a) { a(margin_, lists_built_, *packing_); }

 private:
  const Container* container_;
  const Places* places_;
  bool snug_, by_octaves_;
  double first_margin_;
  std::unique_ptr<SoftPacking> packing_;
  double margin_ = 0, least_margin_ = 0;
  Effect lists_built_;
};

/// The ground of a `Crowd` in a box of 1 to 8 dimensions that is periodic along the axes without walls.
/// Instead of larger radii the box is smaller.
template <int D>
class BoxGround {
 public:
  static constexpr int dimension = D;
  /// As of `ContainerGround`. In more than four dimensions a larger factor is faster: for N = 2,000 in five
  /// dimensions at 0.302 and in six at 0.197 it takes 0.4 s and 0.85 s instead of 0.85 s and 1.3 s.
  static constexpr double burst_swelling = D <= 4 ? 1.02 : 1.04;
  static constexpr std::size_t always_stay = 1;
  static constexpr bool crowds_wear_lists = false;
  static constexpr const SweepPolicy& policy() { return patient; }

  static int axes() { return D; }

  /// The spheres are relaxed with the share 1 - `allowed` of their radii, `allowed` being the overlap ratio
  /// that the result may have. Axes with `walls` (empty: none) keep whole spheres between them. Precondition:
  /// every edge is at least the largest diameter times that share.
  BoxGround(const Vector<D>& edges, double allowed, std::vector<bool> walls = {})
      : edges_(edges), allowed_(allowed), walls_(std::move(walls)) {}

  /// Puts the spheres, with centres in [0, edge), into the engine.
  void place(const Spheres<D>& spheres);
  void read_places(Spheres<D>& spheres) const;

  SoftEngine<D>& engine() { return *engine_; }
  void swell(double factor) { engine_->grow(factor == 1 ? burst_swelling : 1 / factor); }
  double margin() const { return margin_; }
  bool narrow_margin() { return false; }

  /// Puts the spheres `ids`, the largest first, into the largest holes.
  void move_to_holes(Spheres<D>& spheres, std::vector<std::uint32_t> ids, Random& random);

  Effect lists_built() const { return lists_built_ + engine_->lists_built(); }

  /// Writes or reads the state. Precondition: the same number of spheres was placed.
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
