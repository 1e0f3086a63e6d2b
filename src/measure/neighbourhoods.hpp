#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal {

/// What single spheres have around them, one entry for each that was asked for.
struct Neighbourhoods {
  /// With spheres and with images of them: summed over all spheres twice `Contacts::pairs`.
  std::vector<std::uint32_t> contacts;
  /// d - ri - rj to the nearest surface of another sphere or of an image, in the scene's unit; negative where
  /// they overlap, infinite where there is none.
  std::vector<double> gaps;
};

/// Of the spheres `of`. A contact is what it is to `measure_contacts_across(gap, …)` at `contact_gap`.
/// Cost: about 1 µs each where spheres are packed. Precondition: two or three dimensions; numbers finite.
Neighbourhoods neighbourhoods(const Spheres<dynamic>&, const Domain&, std::span<const std::uint32_t> of,
                              double gap, double contact_gap);

/// Clearance less radius of the spheres `of`: how far each is from the walls, in the scene's unit. `made`:
/// see `local_container`. Precondition: two or three dimensions, and walls.
std::vector<double> wall_gaps(const Spheres<dynamic>&, const Domain&, std::span<const std::uint32_t> of,
                              const std::shared_ptr<const Container>& made);

}  // namespace bernal
