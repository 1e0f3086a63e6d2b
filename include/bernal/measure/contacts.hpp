#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// Contacts of spheres with each other and with walls. A *contact* is a pair (or a sphere and a wall) with a
/// gap ratio below `contact_gap`: (d - ri - rj) / (ri + rj) for a pair, (clearance - r) / r for a wall. In a
/// periodic domain each touching image of a pair is a contact, and a sphere can touch its own image.
///
/// *Rattlers* are spheres with fewer than D + 1 contacts, removed one by one until every remaining sphere has
/// that many; contacts with a sphere's own image do not count. The remaining spheres are the *backbone*.
struct Contacts {
  double contact_gap = 0.002;
  std::uint64_t pairs = 0;  ///< sphere-sphere contacts
  std::uint64_t walls = 0;  ///< sphere-wall contacts, one per facet, edge or corner
  std::uint64_t rattlers = 0;
  double coordination = 0;  ///< mean number of sphere-sphere contacts per sphere: 2 pairs / N

  std::uint64_t backbone = 0;        ///< spheres that are not rattlers
  std::uint64_t backbone_pairs = 0;  ///< contacts among them
  std::uint64_t backbone_walls = 0;
  double backbone_coordination = 0;  ///< 2 backbone_pairs / backbone
  /// The isostatic number: the contacts, walls included, that just hold a backbone of frictionless spheres
  /// under pressure. It is the number of degrees of freedom, D backbone, minus the rigid motions that no wall
  /// prevents (`symmetries_of` the domain: D in a periodic box, 1 in a cylinder, 3 in a sphere), plus one for
  /// the box or sphere size at which they jam. A bed held by its weight needs one less; by the D + 1 rule it
  /// has hardly any backbone. Absent without a backbone.
  std::optional<std::uint64_t> isostatic;
  /// Contacts of the backbone, to compare with `isostatic`.
  std::uint64_t backbone_contacts() const { return backbone_pairs + backbone_walls; }
};

/// Cost: O(N), about 1 µs a sphere in a periodic box of three dimensions. Any dimension, any size ratio,
/// periods as short as one sphere; along periodic axes centres may lie anywhere. Precondition: spheres of the
/// domain's dimension. Throws Error{bad_argument} if the gap ratio is beyond ±1 or not a number.
Contacts measure_contacts(const Spheres<dynamic>&, const Domain&, double contact_gap = 0.002);

/// The same for several gap ratios, in their order, at the cost of the largest. `made`: as
/// `MeasureOptions::container`.
std::vector<Contacts> measure_contacts(const Spheres<dynamic>&, const Domain&,
                                       std::span<const double> contact_gaps,
                                       const std::shared_ptr<const Container>& made = {});

/// The same for spheres that keep a gap from each other and `wall_gap` from the walls, in the domain's unit.
/// A contact is then a pair at that distance: gap ratios are those of spheres enlarged by half the gap,
/// between walls shifted to match.
std::vector<Contacts> measure_contacts_across(double gap, double wall_gap, const Spheres<dynamic>&,
                                              const Domain&, std::span<const double> contact_gaps,
                                              const std::shared_ptr<const Container>& made = {});

/// The contacts of some spheres, such as those in the core, with all spheres: walls do not lower their number
/// as they do that of spheres at the wall.
struct ContactsOfSome {
  struct At {
    double contact_gap, coordination;  ///< mean number of sphere-sphere contacts of each; 0 without spheres
  };
  std::uint64_t spheres = 0;
  std::vector<At> by_gap;  ///< in the order of the gaps
};

/// Of the spheres that are `counted`; with `gap` as `measure_contacts_across`. Cost and errors: those of
/// `measure_contacts`. Precondition: a mark for each sphere.
ContactsOfSome contacts_of_some(const std::vector<bool>& counted, double gap, const Spheres<dynamic>&,
                                const Domain&, std::span<const double> contact_gaps);

}  // namespace bernal
