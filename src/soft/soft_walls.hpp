#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/domain/container.hpp"
#include "core/archive.hpp"
#include "core/made.hpp"
#include "soft/facet_table.hpp"
#include "soft/soft_kernels.hpp"

namespace bernal {

/// What the walls do to the spheres of a group, one entry a lane. Sums are over the wall contacts of a
/// sphere: of the overlaps as vectors, of their number, of the squared overlap ratios (r - d) / r, and of the
/// overlaps (`depth`). `worst` is the largest overlap ratio.
struct alignas(64) WallPush {
  std::array<float, lanes> x{}, y{}, z{}, contacts{}, squares{}, worst{}, depth{};
  std::array<SoftSphere, lanes> before{};  // the group before it moves
  std::array<double, lanes> free{};        // no wall is nearer than this to the centre
};

/// The walls of a container, for spheres that overlap them while they relax.
///
/// Every facet, edge and corner nearer than the radius pushes along the line to its nearest point. Facets
/// whose pushes agree in direction to 25° are one smooth patch, of which only the deepest pushes: so it makes
/// no difference how a face is cut into triangles. No centre passes a wall: a move ends at nine tenths of the
/// way to the first facet in its path. When lists are built anew, the same holds for the way of a sphere that
/// was not near a wall and has moved farther than its clearance.
///
/// The container gives the facets near a sphere once; they are kept until the sphere has moved by the skin.
/// The distance of a facet is computed again only when the sphere has moved far enough to touch it. The
/// facets that a sphere touches, or may touch soon, are replaced by planes through the nearest points, for
/// all facets of a patch, until the sphere has moved by the share `leeway` of its radius. The error of that
/// is at most leeway² / 2 radii; `look_anew` avoids it. If there are too many facets, the container itself is
/// asked for the contacts. Cost of a sweep: about 10 ns for a sphere near a wall, 20 ns for a distance from a
/// facet, some µs for a question to the container.
///
/// Distances here are those from the facets. If the wall of a container stands inside of its facets, or
/// behind them, radii at walls are larger by that inset. So a centre never passes the facets.
class SoftWalls {
 public:
  /// The coordinate of a SoftSphere on axis k is corner[k] + unit[k] · x[k], with x[k] as an unsigned number.
  SoftWalls(const Container& container, const Vector<3>& corner, const Vector<3>& unit, std::size_t spheres);

  /// Puts spheres that were not near a wall at the last `build`, and have passed it since, back in front of
  /// it, on their straight way. Precondition: `built_at` are the spheres at that time, in the same order.
  void stop_strays(std::vector<SoftSphere>& spheres, const std::vector<SoftSphere>& built_at,
                   const std::vector<std::uint32_t>& ids) const;

  /// Finds the spheres that may meet a wall before they have moved by the skin, and the facets that they may
  /// meet. `spheres` and `ids` are in sweep order. Precondition: all centres are inside. Parallel. Cost: a
  /// bounded distance for each sphere near the wall, and `facets_near` for those that have moved.
  void build(const std::vector<SoftSphere>& spheres, const std::vector<std::uint32_t>& ids, float skin);

  /// Forgets what is known of a sphere that is about to be elsewhere.
  void forget(std::uint32_t id) {
    stands_[id] = {};
    views_[id] = {};
  }

  /// Writes or reads the state, between two sweeps.
  void archive(Archive& a) {
    a(skin_, facets_, stands_, views_, first_, near_, has_fine_, until_, least_until_, planes_);
  }

  /// Makes radii at walls smaller by this length.
  void relieve(double by) { relief_ = by; }

  /// Whether the next sweep computes distances from facets, and not from planes in their place.
  void look_anew(bool anew) { anew_ = anew; }

  bool near(std::size_t group) const { return first_[group] < first_[group + 1]; }
  /// If the container has to be asked, computes in threads what `push` returns during the next sweep, for
  /// sweeps in one thread. Precondition: a group does not move before its `push`.
  void push_ahead(const std::vector<SoftSphere>& spheres);
  /// Precondition: near(group); `spheres` is the group's first.
  void push(std::size_t group, const SoftSphere* spheres, WallPush& out);
  /// Shortens the moves of the group since `push.before` so that no centre passes a wall.
  void guard(std::size_t group, const WallPush& push, SoftSphere* spheres) const;

 private:
  static constexpr std::uint32_t run = 32;  // the number of pieces that share an entry of least_until_
  /// A centre keeps this share of its distance from a facet when it moves towards it.
  static constexpr double kept = 0.1;
  /// Where a sphere stood when its distance from the walls was computed, and a lower bound of that distance.
  /// Most spheres need no more when lists are built.
  struct Stand {
    using ArchivedAsBytes = void;
    Vector<3> at = Vector<3>::Zero();
    double clearance = 0;
  };
  struct Piece {
    using ArchivedAsBytes = void;
    double distance;  // from Stand::at
    FacetTable::Number facet;
  };
  /// The facets near a sphere, from there.
  struct View {
    double reach = 0;           // all facets nearer than this are known
    bool is_fine = false;       // whether they are too many to be stored: then none is
    std::vector<Piece> pieces;  // nearest first
    void archive(Archive& a) { a(reach, is_fine, pieces); }
  };
  /// A facet that a sphere may meet. Its distance from the centre is at least `until` less NearSphere::way.
  struct NearPiece {
    using ArchivedAsBytes = void;
    float until;
    FacetTable::Number facet;
  };
  /// A sphere that may meet a wall before lists are built anew, for sweeps, in their order. Most sweeps only
  /// read the first members.
  struct NearSphere {
    using ArchivedAsBytes = void;
    std::array<std::int32_t, 3> seen_from{};  // where it was when facets were looked at last
    float seen_to = 0;                        // facets nearer than this have planes; 0: none has
    float free = 0;                           // no wall is nearer to `seen_from`
    std::uint16_t lane = 0;
    std::uint8_t planes = 0;  // their number, at most `most_planes`
    bool is_fine = false;     // as of its view
    std::uint32_t id = 0, first = 0, first_run = 0,
                  count = 0;  // its pieces: the first `count` of its view, in until_
    Vector<3> built_at = Vector<3>::Zero(), last = Vector<3>::Zero();  // `last` is `seen_from` as a place
    double way = 0;  // at least the way from `built_at` to `last`, back and forth
    /// No facet that is not among its pieces is nearer to `built_at`; of a fine view none at all is nearer to
    /// `last` than this less `way`.
    double beyond = 0;
  };
  /// A plane in place of a facet, from `seen_from`. The planes of a patch follow each other.
  struct Plane {
    using ArchivedAsBytes = void;
    std::array<float, 3> normal;
    float distance;
    std::uint32_t patch;
  };
  /// A move in single precision.
  struct Step {
    std::array<float, 3> x;
    float squared() const { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; }
  };
  static constexpr std::uint32_t most_planes = 8;
  /// The results of a task of `build`.
  struct Found {
    struct Ends {
      std::size_t near = 0, until = 0, least_until = 0;
    };
    std::vector<NearSphere> near;
    std::vector<NearPiece> until;
    std::vector<float> least_until;
    bool has_fine = false;
  };

  double radius_at_wall(const SoftSphere& s) const { return s.r + inset_ - relief_; }
  Vector<3> place(const SoftSphere& s) const {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) p[k] = corner_[k] + unit_[k] * static_cast<std::uint32_t>(s.x[k]);
    return p;
  }
  Vector<3> way_between(const SoftSphere& from, const SoftSphere& to) const;
  /// The move from one place of a sphere to another. Along an axis that repeats itself the coordinate jumps
  /// by a period when the sphere passes the end; the move does not.
  Vector<3> way(const Vector<3>& from, const Vector<3>& to) const {
    const Vector<3> direct = to - from;
    return repeats_ ? container_.boundary().minimum_image(direct) : direct;
  }
  /// That place, or of walls that are not the same everywhere along the axes that repeat themselves its image
  /// nearest to where the sphere stood when it was shown its facets.
  Vector<3> seen_from(std::uint32_t id, const Vector<3>& at) const {
    return varies_ ? stands_[id].at + way(stands_[id].at, at) : at;
  }
  /// Takes back all but a share of the way.
  static void shorten(SoftSphere& to, const SoftSphere& from, double share);
  void stop_stray(SoftSphere& sphere, const SoftSphere& built_at, const Stand&) const;
  void add_near(std::uint32_t lane, std::uint32_t id, const SoftSphere& sphere, Found& found) const;
  void join(const std::vector<Found>& found);
  Step step(const std::int32_t* from, const std::int32_t* to) const {
    Step step;
    for (std::size_t k = 0; k < 3; ++k)
      step.x[k] =
          float_unit_[k] * static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(to[k]) -
                                                                        static_cast<std::uint32_t>(from[k])));
    return step;
  }
  void work_out(std::size_t group, const SoftSphere* spheres, WallPush& out);
  bool push_by_planes(std::uint32_t n, const SoftSphere& sphere, WallPush& out) const;
  double touch(std::uint32_t n, double r, std::vector<WallContact>& contacts);
  void take_for_planes(std::uint32_t n, double r, double reach, std::vector<WallContact>& contacts);
  /// No facet that is not among the pieces of a sphere is nearer to this place.
  double beyond(const NearSphere& near, const Vector<3>& at) const {
    return near.beyond - way(near.built_at, at).norm();
  }
  double look_through(const NearSphere&, double reach, std::vector<WallContact>& contacts);
  double ask(NearSphere&, double r, std::vector<WallContact>& contacts) const;
  bool look(const Vector<3>& at, double r, double skin, std::uint32_t id);

  const Made made_{"walls"};
  const Container& container_;
  const bool repeats_;  // along some axis
  const bool varies_;   // and facets of one period are not those of the next
  const double inset_;
  double relief_ = 0;
  Vector<3> corner_, unit_;
  std::array<float, 3> float_unit_;
  double resolution_;
  double skin_ = 0;
  FacetTable facets_;
  std::vector<Stand> stands_;         // by id
  std::vector<View> views_;           // by id
  std::vector<std::uint32_t> first_;  // of a group in near_
  std::vector<NearSphere> near_;      // by group
  std::vector<Plane> planes_;         // `most_planes` for each of near_
  bool anew_ = false;
  bool has_fine_ = false;           // whether some view is fine
  std::vector<WallPush> ahead_;     // of every group, or empty
  std::vector<NearPiece> until_;    // of all near spheres
  std::vector<float> least_until_;  // the least `until` of each `run` of pieces: a sphere can have hundreds
};

}  // namespace bernal
