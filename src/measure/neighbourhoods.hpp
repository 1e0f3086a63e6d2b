#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// The surroundings of single spheres, one entry for each requested sphere.
struct Neighbourhoods {
  /// Contacts with spheres and images; summed over all spheres twice `Contacts::pairs`.
  std::vector<std::uint32_t> contacts;
  /// d - ri - rj to the nearest surface of another sphere or image, in the scene's unit; negative for an
  /// overlap, infinite if there is none.
  std::vector<double> gaps;
};

/// For the spheres `of`. Contacts are those of `measure_contacts_across(gap, …)` at `contact_gap`. Cost:
/// about 1 µs each in a packing. Precondition: two or three dimensions; finite numbers.
Neighbourhoods neighbourhoods(const Spheres<dynamic>&, const Domain&, std::span<const std::uint32_t> of,
                              double gap, double contact_gap);

/// Clearance minus radius of the spheres `of`, in the scene's unit. `made`: see `local_container`.
/// Precondition: two or three dimensions, and walls.
std::vector<double> wall_gaps(const Spheres<dynamic>&, const Domain&, std::span<const std::uint32_t> of,
                              const std::shared_ptr<const Container>& made);

}  // namespace bernal
