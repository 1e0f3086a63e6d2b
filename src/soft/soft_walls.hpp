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

/// What the walls do to the spheres of a group, one entry a lane, in the terms in which neighbours act: sums
/// of overlaps over the wall contacts, how many these are, their overlap ratios (r - d) / r squared and at
/// most, and how deep they are together.
struct alignas(64) WallPush {
  std::array<float, lanes> x{}, y{}, z{}, contacts{}, squares{}, worst{}, depth{};
  std::array<SoftSphere, lanes> before{};  // the group as it was
  std::array<double, lanes> free{};        // no wall is nearer than this to the centre
};

/// The wall of a container, for spheres that overlap it while they relax.
///
/// Every facet, edge and corner nearer than the radius pushes along the line to its nearest point; of a
/// smooth patch, whose pushes agree in direction to 25°, only the deepest does, and so of a face in many
/// triangles and of its edges that are no nearer: how a wall is cut into facets makes no difference. No
/// centre ever passes the wall: a move is shortened to nine tenths of the way to the first facet in its path,
/// and so is, when lists are built anew, the way of a sphere that was far from the wall and has moved farther
/// than that.
///
/// Facets are asked for once and kept with the sphere until it has moved by the skin; one is looked at again
/// only when the sphere has gone far enough since the last time to touch it. What a sphere touches, or may
/// soon, it takes for planes through the nearest points, of each patch those of all facets, until it has
/// moved by the share `leeway` of its radius: that is wrong by no more than leeway²/2 radii there, and right
/// where `look_anew` says so. Where there are too many facets for all that, the container is asked for the
/// contacts instead. Cost of a sweep: about 10 ns a sphere that is near a wall, 20 ns a facet that is looked
/// at, some µs where the container is asked.
///
/// Distances in here are those from the facets, and of a container whose wall stands inside of them, or
/// behind, radii are by that inset larger at a wall: so a centre never passes the facets in any case.
class SoftWalls {
 public:
  /// Spheres have the radii that SoftSphere gives them, times at most `swelling`. A sphere's place on axis k
  /// is corner[k] + unit[k] · x[k], x[k] as an unsigned number.
  SoftWalls(const Container& container, const Vector<3>& corner, const Vector<3>& unit, std::size_t spheres);

  /// Stops what was far from the wall and has come through it on the straight way since the last `build`,
  /// before it. Precondition: `built_at` are the spheres at that time, in the same order.
  void stop_strays(std::vector<SoftSphere>& spheres, const std::vector<SoftSphere>& built_at,
                   const std::vector<std::uint32_t>& ids) const;

  /// Finds the spheres that may meet a wall before they have moved by the skin, and what they may meet.
  /// `spheres` and `ids` are in sweep order. Precondition: all centres are inside. Parallel. Cost: a bounded
  /// distance a sphere near the wall, and `facets_near` for those that have moved.
  void build(const std::vector<SoftSphere>& spheres, const std::vector<std::uint32_t>& ids, float skin);

  /// Forgets what is known of a sphere that is about to be elsewhere.
  void forget(std::uint32_t id) {
    stands_[id] = {};
    views_[id] = {};
  }

  /// Between two sweeps: all that it knows.
  void archive(Archive& a) {
    a(skin_, facets_, stands_, views_, first_, near_, has_fine_, until_, least_until_, planes_);
  }

  /// At walls radii are smaller by so much from now on.
  void relieve(double by) { relief_ = by; }

  /// For the sweep to come no plane stands for a facet, if `anew`.
  void look_anew(bool anew) { anew_ = anew; }

  bool near(std::size_t group) const { return first_[group] < first_[group + 1]; }
  /// Where the container has to be asked, works out in all threads what `push` will say during one sweep: for
  /// sweeps that have only one. Until its push a group of `spheres` stays where it is.
  void push_ahead(const std::vector<SoftSphere>& spheres);
  /// Precondition: near(group); `spheres` is the group's first.
  void push(std::size_t group, const SoftSphere* spheres, WallPush& out);
  /// Shortens the moves of the group from `push.before` so that no centre passes the wall.
  void guard(std::size_t group, const WallPush& push, SoftSphere* spheres) const;

 private:
  static constexpr std::uint32_t run = 32;  // pieces that share an entry of least_until_
  /// Where a sphere stood when it looked for the wall, and how far from it, or a lower bound of that: all
  /// that most spheres look at when lists are built.
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
  /// What it saw from there.
  struct View {
    double reach = 0;           // all pieces nearer than this are there
    bool is_fine = false;       // too many for that: none is
    std::vector<Piece> pieces;  // nearest first
    void archive(Archive& a) { a(reach, is_fine, pieces); }
  };
  /// One that a sphere may meet, and no nearer to its centre than `until` less NearSphere::way.
  struct NearPiece {
    using ArchivedAsBytes = void;
    float until;
    FacetTable::Number facet;
  };
  /// A sphere that may meet a wall until lists are built anew: what a sweep touches, in its order. The first
  /// four members are all that most sweeps look at.
  struct NearSphere {
    using ArchivedAsBytes = void;
    std::array<std::int32_t, 3> seen_from{};  // where it was when facets were looked at last
    float seen_to = 0;                        // the planes of all nearer than that are known; 0: of none
    float free = 0;                           // no wall is nearer, from there
    std::uint16_t lane = 0;
    std::uint8_t planes = 0;  // of `most_planes`
    bool is_fine = false;     // there are too many pieces: it has none
    std::uint32_t id = 0, first = 0, first_run = 0,
                  count = 0;             // its pieces, the first `count` of its view, in until_
    Vector<3> last = Vector<3>::Zero();  // the place `seen_from`
    double way = 0;                      // gone to there since the lists were built, or more
    double beyond = 0;                   // no other piece is nearer to it than this less the way
  };
  /// What a sphere may touch, as seen from there. Those of one patch come one after the other.
  struct Plane {
    using ArchivedAsBytes = void;
    std::array<float, 3> normal;
    float distance;
    std::uint32_t patch;
  };
  /// How far a sphere has gone, in single precision.
  struct Step {
    std::array<float, 3> x;
    float squared() const { return x[0] * x[0] + x[1] * x[1] + x[2] * x[2]; }
  };
  static constexpr std::uint32_t most_planes = 8;
  /// What a task of `build` finds.
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
  Vector<3> place(const SoftSphere& s) const;
  Vector<3> way_between(const SoftSphere& from, const SoftSphere& to) const;
  /// The short way from one place of a sphere to another; along an axis that repeats itself the place jumps
  /// by a period when the sphere passes its end, while the sphere and the wall beside it go on.
  Vector<3> way(const Vector<3>& from, const Vector<3>& to) const {
    const Vector<3> direct = to - from;
    return repeats_ ? container_.boundary().minimum_image(direct) : direct;
  }
  void stop_stray(SoftSphere& sphere, const SoftSphere& built_at, const Stand&) const;
  void add_near(std::uint32_t lane, std::uint32_t id, const SoftSphere& sphere, Found& found) const;
  void join(const std::vector<Found>& found);
  Step step(const std::int32_t* from, const std::int32_t* to) const;
  void work_out(std::size_t group, const SoftSphere* spheres, WallPush& out);
  bool push_by_planes(std::uint32_t n, const SoftSphere& sphere, WallPush& out) const;
  double touch(std::uint32_t n, double r, std::vector<WallContact>& contacts);
  void take_for_planes(std::uint32_t n, double r, double reach, std::vector<WallContact>& contacts);
  double look_through(const NearSphere&, double reach, std::vector<WallContact>& contacts);
  double ask(NearSphere&, double r, std::vector<WallContact>& contacts) const;
  bool look(const Vector<3>& at, double r, double skin, std::uint32_t id);

  const Made made_{"walls"};
  const Container& container_;
  const bool repeats_;  // along some axis
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
  bool has_fine_ = false;           // some view is
  std::vector<WallPush> ahead_;     // of every group, or none
  std::vector<NearPiece> until_;    // of all near spheres
  std::vector<float> least_until_;  // of every so many pieces of a sphere: a fine mesh has thousands of them
};

}  // namespace bernal
