#pragma once
#include <span>
#include <string_view>

#include "bernal/core/spheres.hpp"
#include "bernal/core/unit.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/measure/contacts.hpp"
#include "bernal/measure/lower_part.hpp"

namespace bernal {

/// The slab between two planes, "z = 10..40" or "0.6 x + 0.8 z = 5 mm..2 cm", or one side of a plane, "z <
/// 20": a sum of multiples of x, y and z, and lengths, in `unit` where they have none of their own. Throws
/// Error{bad_argument} for anything else.
LowerPart slab_in(std::string_view text, Unit unit);

/// What a slab holds.
struct Slab {
  LowerPart part;  ///< between planes that meet the domain
  /// Counts of each sphere what lies in the slab, and of the container, too. Exact to rounding.
  double packing_fraction;
  ContactsOfSome contacts;  ///< of the spheres whose centres lie in it
};

/// At several gap ratios, with `gap` as `measure_contacts_across`. Cost: that of `contacts_of_some`, and
/// O(facets). Throws Error{bad_argument} for a slab that holds nothing of the domain, and in a domain without
/// walls, that repeats itself across the slab, or of other than two or three dimensions.
Slab measure_slab(const LowerPart&, const Spheres<dynamic>&, const Domain&,
                  std::span<const double> contact_gaps, double gap = 0);

}  // namespace bernal
