#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "core/archive.hpp"
#include "domain/places.hpp"
#include "near/cell_grid.hpp"
#include "work/effect_log.hpp"
#include "work/room.hpp"

namespace bernal {

/// The effect of `walls = "exact"`: decisions about walls that doubles would nearly always have made.
inline constexpr std::string_view exact_walls_effect = "exact walls";

/// The place of a centre of two or three coordinates; of two in the plane z = 0.
inline Vector<3> place_in_bed(const Vector<dynamic>& center) {
  Vector<3> place = Vector<3>::Zero();
  place.head(center.size()) = center;
  return place;
}

/// The bed: spheres in their container while they are being packed, in the packer's frame; in a container of
/// two dimensions discs, which stay in the plane z = 0.
///
/// Every stage obeys walls and neighbours through the same two calls: `fits` for a sphere that appears,
/// `Mover::free_path` for one that moves. Both keep every gap at or above skin/2 (core/tolerance.hpp), so
/// that nothing ever overlaps. Both decide about walls as the container's WallArithmetic says: `fits` by
/// `Container::contains`, `Mover` by the rule of kernels/first_contact.hpp, in doubles, to which the skin
/// makes it a bound, or exactly.
///
/// Between two calls of `enclose` each sphere may move within its own bounding box, a cube around its place
/// at the time of the call; neighbours and near walls are those that the boxes allow (Han, Feng & Owen 2005,
/// section 2.1: the lists of all spheres are built together).
///
/// Along the axes of the container that repeat themselves every sphere is all of its images. Of these the
/// centre is the one in the container's period when it appears and when it is enclosed, and lists hold the
/// nearest: a period is at least `least_period` largest diameters, and bounding boxes are no larger than
/// `longest_buffer`, so that no sphere can meet two images of another, or its own, before lists are built
/// anew.
class Bed {
 public:
  using Id = std::uint32_t;

  struct Ball {
    using ArchivedAsBytes = void;
    Vector<3> center;
    double r;
  };

  /// In largest diameters.
  static constexpr double least_period = 3;

  /// Radii to come lie in [r_min, r_max]; `expected` is about how many spheres will come. Throws
  /// Error{bad_argument} for a period that is too short for them.
  Bed(const Container& container, double r_min, double r_max, std::size_t expected, EffectLog& effects);

  const Container& container() const { return container_; }
  const Places& places() const { return places_; }
  std::size_t size() const { return balls_.size(); }
  const Ball& operator[](Id i) const { return balls_[i]; }
  std::uint32_t tag(Id i) const { return tags_[i]; }
  /// The tags of all spheres, ascending.
  std::vector<std::uint32_t> tags() const;
  double skin() const { return skin_; }
  double mean_radius() const { return balls_.empty() ? 0 : sum_of_radii_ / static_cast<double>(size()); }
  double packing_fraction() const { return sum_of_volumes_ / container_.volume(); }
  /// Mean of the volume-weighted height of the spheres against `direction`: potential energy a volume.
  double potential(const Vector<3>& direction) const;
  int dimension() const { return container_.dimension(); }
  /// A random unit vector of the container's dimension.
  Vector<3> random_direction(Random& random) const;

  /// Whether a sphere may appear at c: no neighbour and no wall nearer than the skin. O(1) besides the wall.
  bool fits(const Vector<3>& c, double r) const;
  /// The same without the wall.
  bool fits_between_spheres(const Vector<3>& c, double r) const;

  /// The spheres, each a skin larger than it is, and the walls, farther off by `give`.
  Surroundings surroundings(double give = 0) const;

  /// The radius, at most `limit`, of the largest sphere at c that overlaps no other; any value below `enough`
  /// where it is below that. Walls are not asked.
  double room_between_spheres(const Vector<3>& c, double enough, double limit) const;

  /// Adds a sphere that fits. `tag` is the caller's name for it: its place in the drawn sequence.
  void insert(const Vector<3>& c, double r, std::uint32_t tag);

  /// Adds them all to an empty bed, tags 0, 1, …, if each fits between walls and those before it. Returns
  /// whether they do; where not, or where walls decide exactly, the bed stays empty. Parallel.
  bool insert_if_all_fit(const Spheres<3>& spheres);

  /// Removes all spheres whose tag is `first` or greater.
  void remove_tags_from(std::uint32_t first);

  /// Puts the spheres in ascending order of height against `direction`, layer by layer, which is the order
  /// in which sweeps visit them and in which they lie in memory.
  void sort_by_height(const Vector<3>& direction);

  /// Tells the background grid where the spheres have moved to; `fits` and `room_between_spheres` need it
  /// after spheres have moved.
  void update_grid();

  /// Gives every sphere a bounding box with `buffer` to move in on each side, at most `longest_buffer`, and
  /// builds the neighbour lists and near walls of all spheres together. Returns that buffer. Parallel; the
  /// same lists for any number of threads. O(N).
  double enclose(double buffer);

  /// In a period of length L with radii up to R, L/8 - R/2 less the skin: two spheres that boxes allow to
  /// meet are then nearer than L/2 on that axis, wherever they are in their boxes. Without periods infinite.
  double longest_buffer() const { return longest_buffer_; }

  /// The spheres that sphere i may meet within their bounding boxes.
  std::span<const Id> neighbors(Id i) const {
    return {neighbors_.data() + first_neighbor_[i], first_neighbor_[i + 1] - first_neighbor_[i]};
  }

  /// How many neighbours the lists hold for a sphere, on average.
  double mean_neighbors() const {
    return balls_.empty() ? 0 : static_cast<double>(neighbors_.size()) / static_cast<double>(size());
  }

  /// The spheres in the order of their tags, centres in the period.
  Spheres<3> spheres() const;
  /// The same with as many coordinates as the container has.
  Spheres<dynamic> spheres_as_packed() const;

  /// What it was made for.
  struct Sizes {
    using ArchivedAsBytes = void;
    double r_min, r_max;
    std::size_t expected;
  };
  const Sizes& made_for() const { return made_for_; }
  /// All spheres, in a bed that was made for the same; `enclose` comes next.
  void archive(Archive& a) {
    a(balls_, tags_, grid_, sum_of_radii_, sum_of_volumes_, far_from_wall_, far_from_wall_at_);
  }

 private:
  friend class Mover;
  void reorder(const std::vector<Id>& order);
  /// Of decisions about walls, where these are made exactly; else null.
  Effect* exact_walls() const {
    return container_.arithmetic() == WallArithmetic::exact ? &effects_[exact_walls_effect] : nullptr;
  }
  void wrap();
  /// The way from a to the nearest image of b.
  Vector<3> way(const Vector<3>& a, const Vector<3>& b) const {
    const Vector<3> direct = b - a;
    return repeats_ ? container_.boundary().minimum_image(direct) : direct;
  }

  const Container& container_;
  const Sizes made_for_;
  EffectLog& effects_;
  const Made made_{"walls"};
  const bool repeats_;  // along some axis
  double skin_;
  double longest_buffer_;
  std::vector<Ball> balls_;
  std::vector<std::uint32_t> tags_;
  Places places_;
  CellGrid<3> grid_;
  double sum_of_radii_ = 0;
  double sum_of_volumes_ = 0;

  double buffer_ = 0;
  std::vector<Vector<3>> box_centers_;
  std::vector<std::size_t> first_neighbor_;  // CSR: neighbours of i start here
  std::vector<Id> neighbors_;
  std::vector<char> meets_images_;        // of its neighbours, where they are not themselves the nearest
  std::vector<std::size_t> first_facet_;  // CSR: walls near i start here, nearest first
  std::vector<NearFacet> facets_;
  std::vector<double>
      far_from_wall_;  // clearance of the centre is at least this much, less what it moved since
  std::vector<Vector<3>> far_from_wall_at_;
};

}  // namespace bernal
