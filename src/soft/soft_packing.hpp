#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "core/archive.hpp"
#include "soft/far_images.hpp"
#include "soft/list_life.hpp"
#include "soft/soft_blocks.hpp"
#include "soft/soft_lists.hpp"
#include "soft/soft_walls.hpp"
#include "work/effect_log.hpp"

namespace bernal {

/// How spheres are best moved in three dimensions.
struct Pace {
  float omega;  ///< over-relaxation, see SoftKernels::sweep
  double wear;  ///< of the lists, see SoftPacking::wear_lists
};
/// By the largest overlap ratio that was measured last: hastily while spheres are crowded.
///
/// At six contacts a sweep stops being stable at omega = 6; nearer to that it agitates the spheres, which
/// finds denser packings while they are crowded, and loses contacts when they come to rest. 3 instead of 5
/// costs 0.004 of packing fraction. As the normals of n contacts have a mean square of 1 / D along any axis,
/// a Newton step is D / n times the sum of the overlaps, and these are 1.87 and 1.67 of it: in other
/// dimensions omega goes with D / 3. The missed neighbours of lists worn twice do no harm to crowded spheres,
/// and a third of the time is saved; of lists worn more than four times they do, 0.02 of packing fraction.
Pace pace_for(double largest_overlap);

/// Overlapping spheres that push each other apart, in a periodic box of one, two or three dimensions or in a
/// container: the state of the fast relaxation. In single precision and fixed point: overlap ratios are good
/// to about 1e-6.
///
/// In a container the box is the container's period along the axes that repeat themselves, and along others
/// its bounds and so much more that no sphere meets an image.
class SoftPacking {
 public:
  /// How much larger than given the radii may become in a container.
  static constexpr double most_swelling = 1.05;

  /// Centres in [0, edge). `by_octaves` as of `SoftLists`. Precondition: every edge is at least the largest
  /// diameter, and will be. Below `smallest_edge` of the radii spheres meet far images, too, see `FarImages`.
  /// The last `resting` spheres are neighbours of the others, push them, and stay where they are.
  /// Preconditions: some move; where some rest, every edge is at least the `smallest_edge`.
  template <int D>
  SoftPacking(const Spheres<D>& spheres, const Vector<D>& edges, const SoftKernels& kernels,
              bool by_octaves = false, std::size_t resting = 0);

  /// Precondition: all centres are inside the container, which outlives this; its periods are at least
  /// `most_swelling` times the `smallest_edge` of the radii.
  SoftPacking(const Spheres<3>& spheres, const Container& container, const SoftKernels& kernels);

  /// In a container: at its walls radii are smaller by so much. Before the first sweep.
  void relieve_walls(double by) { walls_->relieve(by); }

  /// That of lists, at most, in the unit of the radii.
  static double usual_skin(const std::vector<double>& radii);
  /// The least edge in which no two images of a sphere are neighbours of one.
  static double smallest_edge(const std::vector<double>& radii);
  /// How far apart the centres of two neighbours may be, of spheres with this largest and mean radius.
  static double farthest_neighbor(double largest, double mean);

  /// Lists are built anew when a sphere has moved by `wear` skins. Above 1, neighbours may be missed until
  /// then. 0.9 where nothing is said.
  void wear_lists(double wear) { life_.wear(wear); }

  /// Every sphere is moved once, by min(omega / n, 1) times the sum of its n overlaps. Parallel where there
  /// are many spheres; the same bits for any number of threads.
  void sweep(float omega);
  /// The same; returns the largest overlap ratio that was met.
  double sweep_to_overlap(float omega) { return measure(omega, false); }
  /// The same; `squeeze` and `forces` then tell about each sphere.
  double sweep_and_measure(float omega) { return measure(omega, true); }
  /// Of each sphere the sum of its squared overlap ratios, as the last measuring sweep met them.
  std::vector<float> squeeze() const { return by_id(squeeze_); }
  /// Of each sphere the sum of the forces on it, 2 ri rj / (ri + rj) times the overlap of each contact, as
  /// the last measuring sweep met them: the derivative of the energy, whose half that of a pair is times the
  /// overlap, by its own radius.
  std::vector<float> forces() const { return by_id(force_); }
  /// Sphere to[i] takes the place of sphere i, and becomes i's there: `to` is a permutation. Cost: O(N).
  void exchange(const std::vector<std::uint32_t>& to);

  /// The box and the distances grow; the radii do not.
  void grow(double factor);
  /// The radii become `factor` times those that were given, in a container.
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

  /// How often lists were built.
  const Effect& lists_built() const { return lists_built_; }

  /// All of its state, in one that was made of as many spheres with the same radii in the same box or
  /// container. Lists are not kept but built again, of what they were built of.
  void archive(Archive& a);

 private:
  /// Radii become up to `most` times these; places are still to be set.
  SoftPacking(const std::vector<double>& radii, double most, int dimension, const SoftKernels& kernels,
              bool by_octaves);

  float diameter_of_all() const;
  float move_all(float omega, bool measure, bool each);
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
  std::uint32_t movers_ = nobody;  // the first so many, where others rest
  int dimension_;
  std::array<double, 3> edges_;
  Vector<3> corner_ = Vector<3>::Zero();
  SoftSizes sizes_;
  ListLife life_;
  SoftLists lists_;
  bool by_octaves_;
  std::unique_ptr<SoftBlocks> blocks_;  // where there are so many spheres that they are worth them
  bool in_blocks_ = false;              // the spheres are swept: else by lists_
  std::unique_ptr<SoftWalls> walls_;    // null in a periodic box
  FarImages far_images_;
  std::vector<SoftSphere> spheres_;        // in sweep order
  std::vector<std::uint32_t> sites_;       // in sweep order: what the walls know of a place goes with it
  std::vector<std::uint32_t> id_of_site_;  // of the sphere that stands there
  std::vector<float> squeeze_, force_;
  std::vector<float> radii_;               // as given, by id
  float swelling_ = 1;                     // of these
  std::vector<SoftSphere> built_at_;       // where they were when the lists were built
  std::vector<std::uint32_t> sites_then_;  // in the order in which they came to that
  std::array<double, 3> edges_then_{};
  double wear_then_ = 0;
  Effect lists_built_{"neighbour lists", 0, 0};
};

}  // namespace bernal
