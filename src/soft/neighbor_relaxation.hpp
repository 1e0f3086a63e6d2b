#pragma once
#include <cstdint>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "core/archive.hpp"
#include "core/made.hpp"
#include "soft/fixed_point_grid.hpp"
#include "soft/least_tilted_cell.hpp"
#include "work/effect_log.hpp"

namespace bernal {

/// Overlapping spheres that push each other apart in a periodic box of 1 to 8 dimensions, also between walls:
/// the state of a relaxation where `SoftPacking` does not serve. It moves one sphere after the other, and has
/// no levels of grids for widely differing sizes.
///
/// Numbers are in single precision and fixed point, so that overlap ratios are good to about 1e-6. A
/// coordinate is a whole number of edge / 2^32, so that differences wrap round to the nearest image. In a box
/// less than two diameters across two spheres may overlap in several images; all of them push, as in
/// `SoftKernels`.
///
/// In a tilted box of two or three dimensions a coordinate counts along a vector of its `LeastTiltedCell`.
/// What wraps round along these is the nearest image as long as it is nearer than half of every width of the
/// cell.
template <int D, bool tilted = false>
class NeighborRelaxation {
 public:
  /// Centres in [0, edge). Precondition: every edge, and the shortest period, is at least the largest
  /// diameter.
  NeighborRelaxation(const Spheres<D>& spheres, const Vector<D>& edges, const Tilt& tilt = {});

  /// Along axes with walls, centres keep `share` times their radius away from 0 and from the edge, or stay in
  /// the middle if there is no room for that. So no sphere reaches an image of another across a wall.
  void keep_between_walls(const std::vector<bool>& walls, double share);

  /// Lists are built anew when a sphere has moved by `wear` times half of the skin. Above 1, neighbours may
  /// be missed until then. 0.9 where nothing is said.
  void wear_lists(double wear) { wear_ = wear; }

  /// Moves every sphere once, as `SoftKernels::sweep` does. Cost: 45 ns a sphere in two dimensions, 65 ns in
  /// four, 130 ns in eight.
  void sweep(float omega) { sweep_and_measure(omega); }
  /// The same; returns the largest overlap ratio that the sweep met.
  double sweep_and_measure(float omega);
  double sweep_to_overlap(float omega) { return sweep_and_measure(omega); }
  /// As `SoftPacking::squeeze` and `SoftPacking::forces`.
  std::vector<float> squeeze() const { return by_id(squeeze_); }
  std::vector<float> forces() const { return by_id(force_); }
  /// Sphere to[i] takes the place of sphere i: `to` is a permutation. Cost: O(N).
  void exchange(const std::vector<std::uint32_t>& to) {
    const std::vector<float> radii = by_id(radii_);
    for (std::uint32_t& id : ids_) id = to[id];
    resize(radii);
  }
  /// As `SoftPacking::resize`.
  void resize(const std::vector<float>& radii);

  /// Multiplies the box and all distances; radii stay.
  void grow(double factor);

  void write_to(Spheres<D>& spheres, Vector<D>& edges) const;

  /// How often lists were built.
  const Effect& lists_built() const { return lists_built_; }

  /// Writes or reads the state. What reads it was made of the same number of spheres.
  void archive(Archive& a) {
    a(edges_, scale_, inverse_scale_, walled_, wall_share_, skin_, places_, radii_, ids_, squeeze_, force_,
      neighbors_, list_, built_at_, hits_, stale_, wear_, age_, grown_, lists_built_);
    if constexpr (tilted) a(cell_, is_narrow_);
  }

 private:
  using Floats = typename RegistersFor<D>::Floats;
  using Ints = typename RegistersFor<D>::Ints;
  using Whole = typename RegistersFor<D>::Whole;
  using Place = FixedPlace<D>;
  using Id = std::uint32_t;

  /// What the overlaps of a sphere do to it.
  struct Push {
    Floats sum{};
    float contacts = 0, squeeze = 0, largest = 0, depth = 0;
  };

  bool any_image_within(Id i, Id j, double limit) const;
  const Id* find_overlapping(Id i);
  Push push_from_nearest(Id i, const Id* end) const;
  Push push_from_images(Id i, const Id* end) const;
  void add_to(Push& push, Id i, Id j, const Floats& way, float distance) const;
  Floats any_direction(Id i, Id j) const;
  void keep_lists_valid();
  bool moved_too_far() const;
  std::vector<float> by_id(const std::vector<float>& in_order) const;
  void build_lists();
  void sort_into_cells(double reach);
  void set_scale();
  void stop_at_walls(Id i);
  void move_between_walls(Id i, const Ints& step);
  Floats away(const Place& from, const Place& to) const;
  __m128 squares_of(const Place& from, Id a, Id b, Id c, Id d) const;

  Made made_{"relaxation"}, lists_made_{"neighbour lists"};
  std::size_t count_;
  Vector<D> edges_;
  Floats scale_{}, inverse_scale_{};  // of a unit of the coordinates
  float largest_radius_ = 0;
  LeastTiltedCell<D> cell_;  // of a tilted box
  bool is_narrow_ =
      false;  // whether lists have spheres whose nearest image along the cell vectors is not near
  std::vector<int> walled_;  // axes
  double wall_share_ = 1;
  double thickest_skin_, skin_;  // spheres are neighbours if the gap between them is less
  std::vector<Place> places_;    // sorted by cell; a few that touch nothing follow
  std::vector<float> radii_;
  std::vector<Id> ids_;
  std::vector<float> squeeze_, force_;

  FixedPointGrid<D> grid_;
  std::vector<Id> neighbors_;      // four by four; padded with count_
  std::vector<std::size_t> list_;  // where the list of each sphere begins in neighbors_, and the end
  std::vector<Place> built_at_;
  std::vector<Id> hits_;
  bool stale_ = true;
  double wear_ = 0.9;
  int age_ = 0;       // of the lists, in sweeps
  double grown_ = 0;  // radii, at most, by exchanges since they were built
  Effect lists_built_{"neighbour lists", 0, 0};
};

}  // namespace bernal
