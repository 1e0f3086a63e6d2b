#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Which pairs are contacts: as `measure_contacts_across` has it.
struct ContactOptions {
  double contact_gap = 0.002;    ///< a gap ratio, see Contacts
  double gap = 0, wall_gap = 0;  ///< what spheres keep from each other and from walls, a length
  std::shared_ptr<const Container> container = {};  ///< as `MeasureOptions::container`
};

/// All contacts of spheres, one by one: `Contacts::pairs` of them with each other and `Contacts::walls` with
/// walls. Lengths are in the unit of the spheres.
///
/// Sorted by i, then by j. A pair stands there once, with i < j; a sphere that touches its own image is i ==
/// j; two spheres that touch in several images stand there once for each of them.
struct ContactList {
  static constexpr std::int64_t wall = -1;

  std::vector<std::int64_t> i, j;  ///< indices of the spheres, counted from 0; j is `wall` at a wall
  /// The distance of the surfaces, negative where they overlap: d - ri - rj, at a wall clearance - ri.
  std::vector<double> gap;
  /// Of unit length, from i to j, at a wall from the centre to the wall: a column for each axis. Zero if the
  /// centres coincide.
  std::vector<std::vector<double>> normal;
  /// The middle of the gap, seen from sphere i: a column for each axis. Where j is an image, it may lie
  /// outside the period.
  std::vector<std::vector<double>> place;

  std::size_t size() const { return i.size(); }
};

/// Cost: O(N + contacts log contacts), about 2 µs a sphere; 16 + 8 (1 + 2 D) bytes a contact, twice that on
/// the way. Any dimension, size ratio and period; see `measure_contacts` for its precondition and errors.
ContactList contact_list(const Spheres<dynamic>&, const Domain&, const ContactOptions& = {});

/// What contacts add up to.
struct ContactSums {
  /// The number of sphere-sphere contacts of every sphere; one with its own image counts twice. The mean is
  /// `Contacts::coordination`.
  std::vector<std::uint32_t> coordination;
  /// How many spheres have k such contacts, by k.
  std::vector<std::uint64_t> spheres_by_contacts() const;
  /// The fabric tensor of the sphere-sphere contacts, the mean of n n^T over their normals: D rows, trace 1,
  /// 1/D on the diagonal where no direction is preferred. Its error is about 0.3 / √contacts in three
  /// dimensions. No rows without contacts.
  std::vector<std::vector<double>> fabric;
};

/// Cost: about 1 µs a sphere; 4 bytes a sphere beside the search. Otherwise as `contact_list`.
ContactSums contact_sums(const Spheres<dynamic>&, const Domain&, const ContactOptions& = {});

}  // namespace bernal
