#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "core/archive.hpp"
#include "soft/list_life.hpp"
#include "soft/soft_blocks.hpp"
#include "soft/soft_lists.hpp"
#include "soft/soft_walls.hpp"
#include "work/effect_log.hpp"

namespace bernal {

/// How a sweep moves spheres in three dimensions.
struct Pace {
  float omega;  ///< over-relaxation, see SoftKernels::sweep
  double wear;  ///< of the lists, see SoftPacking::wear_lists
};
/// The pace for the largest overlap ratio that was measured last. It is faster while spheres are crowded.
///
/// With six contacts a sphere a sweep is unstable from omega = 6 on. An omega just below that agitates the
/// spheres: this finds denser packings while they are crowded, and loses contacts when they come to rest.
/// Omega = 3 instead of 5 costs 0.004 of packing fraction. The normals of n contacts have a mean square of
/// 1 / D along any axis, so a Newton step is D / n times the sum of the overlaps. The two values of omega are
/// 1.87 and 1.67 Newton steps; in other dimensions omega is D / 3 times as large. Lists that are worn twice
/// miss neighbours, which does no harm to crowded spheres and saves a third of the time. Lists that are worn
/// more than four times cost 0.02 of packing fraction.
Pace pace_for(double largest_overlap);

/// The state of the fast relaxation: overlapping spheres that push each other apart, in a periodic box of
/// one, two or three dimensions or in a container. Numbers are in single precision and fixed point, so that
/// overlap ratios are good to about 1e-6.
///
/// In a container the box is as long as the container's period along an axis that repeats itself. Along any
/// other axis it is longer than the container's bounds, by so much that no sphere meets an image.
class SoftPacking {
 public:
  /// How much larger than given the radii may become in a container.
  static constexpr double most_swelling = 1.05;

  /// Centres in [0, edge). `by_octaves` as of `SoftLists`. The last `resting` spheres push the others and
  /// stay where they are. Preconditions: at least one sphere moves; every edge is at least the largest
  /// diameter, now and later. In boxes shorter than two of these, spheres meet several images of each other,
  /// see `SoftKernels`. While an edge is shorter than the largest diameter, images at a whole edge and more
  /// do not push.
  template <int D>
  SoftPacking(const Spheres<D>& spheres, const Vector<D>& edges, const SoftKernels& kernels,
              bool by_octaves = false, std::size_t resting = 0);

  /// Preconditions: all centres are inside the container, which outlives this; every period of it is at least
  /// `most_swelling` times the largest diameter.
  SoftPacking(const Spheres<3>& spheres, const Container& container, const SoftKernels& kernels,
              bool by_octaves = false);

  /// In a box, before the first sweep: along axes with walls, centres keep `share` times their radius away
  /// from both ends, or stay in the middle if there is no room for that. So no sphere reaches an image of
  /// another across a wall.
  void keep_between_walls(const std::vector<bool>& walls, double share);

  /// In a container, before the first sweep: radii are smaller by this length where spheres meet walls.
  void relieve_walls(double by) { walls_->relieve(by); }

  /// The largest skin of the lists, in the unit of the radii.
  static double usual_skin(const std::vector<double>& radii);
  /// The largest distance between the centres of two neighbours, for this largest and mean radius.
  static double farthest_neighbor(double largest, double mean);

  /// Lists are built anew when a sphere has moved by `wear` skins. Above 1, neighbours may be missed until
  /// then. 0.9 where nothing is said.
  void wear_lists(double wear) { life_.wear(wear); }

  /// Moves every sphere once, by min(omega / n, 1) times the sum of its n overlaps. Parallel where there are
  /// many spheres; the same bits for any number of threads.
  void sweep(float omega);
  /// The same; returns the largest overlap ratio that the sweep met.
  double sweep_to_overlap(float omega) { return measure(omega, false); }
  /// The same; `squeeze` and `forces` are then known.
  double sweep_and_measure(float omega) { return measure(omega, true); }
  /// The sum of squared overlap ratios of each sphere, as the last measuring sweep met them.
  std::vector<float> squeeze() const { return by_id(squeeze_); }
  /// The sum of the forces on each sphere, as the last measuring sweep met them. The force of a contact is
  /// 2 ri rj / (ri + rj) times the overlap, its energy half of that times the overlap. So the sum is the
  /// derivative of the energy by the radius of the sphere.
  std::vector<float> forces() const { return by_id(force_); }
  /// Sphere to[i] takes the place of sphere i. `to` is a permutation. Cost: O(N).
  void exchange(const std::vector<std::uint32_t>& to);
  /// Gives the spheres other radii than those that were given, none larger than the largest of these. Cost:
  /// O(N).
  void resize(const std::vector<float>& radii);

  /// Multiplies the box and all distances; radii stay.
  void grow(double factor);
  /// In a container: makes the radii `factor` times those that were given.
  void swell(double factor);
  /// A sphere and where it is put.
  struct Move {
    std::uint32_t id;
    Vector<3> to;
  };
  /// Puts spheres elsewhere in the container. Cost: O(N).
  void put(const std::vector<Move>& moves);

  template <int D>
  void write_to(Spheres<D>& spheres, Vector<D>& edges) const;
  /// Centres; those in a container are inside.
  template <int D>
  void write_to(Spheres<D>& spheres) const;

  /// The unit of the coordinates on the longest edge.
  double resolution() const { return 0x1p-32 * *std::max_element(edges_.begin(), edges_.end()); }

  /// See `SoftBlocks`; 0 where spheres are so few that caches keep them.
  std::size_t bytes_a_sweep() const { return in_blocks_ ? blocks_->bytes_a_sweep() : 0; }
  /// Null where spheres are so few.
  const SoftBlocks* blocks() const { return in_blocks_ ? blocks_.get() : nullptr; }

  /// How often lists were built.
  const Effect& lists_built() const { return lists_built_; }

  /// Writes or reads the state. What reads it was made of the same number of spheres, with the same radii, in
  /// the same box or container. Lists are not written: they are built again from the places that they were
  /// built from.
  void archive(Archive& a);

 private:
  /// Radii become up to `most` times these; places are still to be set.
  SoftPacking(const std::vector<double>& radii, double most, int dimension, const SoftKernels& kernels,
              bool by_octaves);

  float diameter_of_all() const;
  unsigned narrow_axes() const;
  void stop_at_walls(SoftSphere& sphere) const;
  float move_all(float omega, bool measure, bool each);
  void take_radii();
  double measure(float omega, bool each);
  template <int D>
  void set_place(SoftSphere& sphere, const Vector<D>& center) const;
  void keep_lists_valid(bool for_all);
  void build_lists(std::vector<SoftSphere>& spheres, std::vector<std::uint32_t>& sites,
                   std::vector<SoftSphere>& spare);
  void remember_places();
  void build_again(Archive& a);
  FarthestMoves farthest_moves(bool of_all) const;
  std::uint32_t id_at(std::size_t p) const { return id_of_site_[sites_[p]]; }
  std::vector<float> by_id(const std::vector<float>& in_sweep_order) const;

  const SoftKernels& kernels_;
  std::size_t count_;
  std::uint32_t movers_ = nobody;  // spheres with smaller ids move, the others rest
  int dimension_;
  std::array<double, 3> edges_;
  Vector<3> corner_ = Vector<3>::Zero();
  unsigned walled_axes_ = 0;  // as `SweepTask::walled_axes`
  double wall_share_ = 1;
  SoftSizes sizes_;
  ListLife life_;
  SoftLists lists_;
  bool by_octaves_;
  std::unique_ptr<SoftBlocks> blocks_;     // where there are so many spheres that they are worth them
  bool in_blocks_ = false;                 // whether blocks_ sweeps the spheres, and not lists_
  std::unique_ptr<SoftWalls> walls_;       // null in a periodic box
  std::vector<SoftSphere> spheres_;        // in sweep order
  std::vector<std::uint32_t> sites_;       // in sweep order; the walls keep what they know by site
  std::vector<std::uint32_t> id_of_site_;  // of the sphere that stands there
  std::vector<float> squeeze_, force_;
  std::vector<float> radii_;               // as given, by id
  float swelling_ = 1;                     // of these
  std::vector<SoftSphere> built_at_;       // where they were when the lists were built
  std::vector<std::uint32_t> sites_then_;  // in their order before that
  std::array<double, 3> edges_then_{};
  Effect lists_built_{"neighbour lists", 0, 0};
};

}  // namespace bernal
