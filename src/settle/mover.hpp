#pragma once
#include <span>
#include <vector>

#include "work/bed.hpp"

namespace bernal {

/// The free path of a sphere, and its end.
struct FreePath {
  enum class End : std::uint8_t { limit, box, neighbor, wall };
  double length = 0;
  End end = End::limit;
  Vector<3> normal = Vector<3>::Zero();  ///< for neighbor and wall: unit, from the obstacle to the sphere

  bool blocked() const { return end == End::neighbor || end == End::wall; }
};

/// Moves the spheres of a bed, one at a time, past their neighbours and walls.
///
/// `pick` gathers the obstacles in the sphere's bounding box into columns, in which `free_path` then tests
/// four neighbours at once; the limiting one is decided by the kernel (kernels/first_contact.hpp). Invariant:
/// every gap stays at or above skin/2. Precondition: `Bed::enclose` was called after the last insertion,
/// removal or sort. One thread a mover. Cost: 3 ns a neighbour for `pick`, 2 for `free_path`.
class Mover {
 public:
  explicit Mover(Bed& bed) : bed_(bed) {}

  void pick(Bed::Id i);

  /// How far the sphere may move along the unit vector u, at most `limit`.
  FreePath free_path(const Vector<3>& u, double limit);

  /// Writes into `normals` (unit, from the obstacle to the sphere) the obstacles with a gap of at most `gap`
  /// that oppose a motion along u, at most `normals.size()` of them. Returns how many. Only a hint for
  /// choosing directions for `free_path`; it does not limit a motion.
  std::size_t contacts(const Vector<3>& u, double gap, std::span<Vector<3>> normals) const;

  /// Moves the sphere along u by a length allowed by `free_path`.
  void advance(const Vector<3>& u, double length);

  /// Moves sphere i to first touch along the unit vector `direction`, and on along the part of that direction
  /// that its contacts allow: in the plane of one contact or along the line of two, until it is held, the
  /// path length reaches `limit` or its bounding box ends. That is rolling without friction. Every leg is one
  /// `free_path`, so no gap falls below skin/2.
  ///
  /// Returns the sphere's displacement. Cost: one pass over the neighbours, and one more a leg.
  double slide(Bed::Id i, const Vector<3>& direction, double limit);

  const Bed::Ball& ball() const { return bed_.balls_[i_]; }

 private:
  friend class Roller;
  void limit_by_box(const Vector<3>& u, FreePath& path) const;
  void limit_by_neighbors(const Vector<3>& u, FreePath& path);
  void limit_by_walls(const Vector<3>& u, FreePath& path) const;
  double first_contact_with(const Facet& facet, const Vector<3>& u, double limit) const;
  std::span<const NearFacet> walls() const;
  double moved() const { return (ball().center - bed_.box_centers_[i_]).norm(); }

  Bed& bed_;
  Bed::Id i_ = 0;
  // One entry a neighbour: its centre relative to the sphere's, the sum of their radii, and scratch.
  std::size_t count_ = 0;
  std::vector<double> x_, y_, z_, sum_, path_;
};

}  // namespace bernal
