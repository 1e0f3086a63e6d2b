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

/// What touches what. A *contact* is a pair (or a sphere and a wall) whose gap is below `contact_gap`:
/// gap ratio = (d - ri - rj) / (ri + rj) for a pair, (clearance - r) / r for a wall. Where the domain repeats
/// itself every image of a pair that touches is a contact, and a sphere may touch its own image.
///
/// *Rattlers* are spheres that fewer than D + 1 contacts hold, taken out one after the other until every one
/// that is left is held; a sphere is not held by its own image. What is left is the *backbone*.
struct Contacts {
  double contact_gap = 0.002;
  std::uint64_t pairs = 0;  ///< sphere-sphere contacts
  std::uint64_t walls = 0;  ///< sphere-wall contacts, one a facet, edge or corner
  std::uint64_t rattlers = 0;
  double coordination = 0;  ///< mean number of sphere contacts of a sphere: 2 pairs / N

  std::uint64_t backbone = 0;        ///< spheres that are no rattlers
  std::uint64_t backbone_pairs = 0;  ///< contacts among them
  std::uint64_t backbone_walls = 0;
  double backbone_coordination = 0;  ///< 2 backbone_pairs / backbone
  /// Contacts that just hold the backbone of frictionless spheres that are pressed together, those with walls
  /// among them: as many as there are displacements, D backbone, less those of all spheres together that no
  /// wall feels (`symmetries_of` the domain: D in a periodic box, 1 in a cylinder, 3 in a sphere), and one
  /// for the size of the box, or of the spheres, at which they jam. In a bed that is held by its weight
  /// instead there is one less, and such a bed has hardly any backbone by the count of D + 1. Absent where
  /// there is no backbone.
  std::optional<std::uint64_t> isostatic;
  /// Those that the backbone has.
  std::uint64_t backbone_contacts() const { return backbone_pairs + backbone_walls; }
};

/// Cost O(N): about 1 µs a sphere in a periodic box of three dimensions. Any dimension, any size ratio, and
/// periods as short as one sphere; along axes with a period centres may lie anywhere. Precondition: spheres
/// of the domain's dimension. Throws Error{bad_argument} for a gap ratio beyond ±1, or that is no number.
Contacts measure_contacts(const Spheres<dynamic>&, const Domain&, double contact_gap = 0.002);

/// The same for every one of the gaps, in their order, at the cost of the largest. `made`: see
/// `local_container`.
std::vector<Contacts> measure_contacts(const Spheres<dynamic>&, const Domain&,
                                       std::span<const double> contact_gaps,
                                       const std::shared_ptr<const Container>& made = {});

/// The same of spheres that keep a gap from each other and one from the walls, in the domain's unit: what
/// holds them in their places are others, and walls, at that distance. So contacts are those of spheres with
/// half the gap around them, between walls that they then touch, and their gap ratios too.
std::vector<Contacts> measure_contacts_across(double gap, double wall_gap, const Spheres<dynamic>&,
                                              const Domain&, std::span<const double> contact_gaps,
                                              const std::shared_ptr<const Container>& made = {});

}  // namespace bernal
