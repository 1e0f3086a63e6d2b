#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "bernal/scene/scene.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {

/// Which spheres of a packing with zones do not lie in the place of theirs. Layers of a bed have no place:
/// those above lie in the hollows of those below.
struct ZonesInPlace {
  std::vector<std::uint64_t> misplaced;  ///< ascending
};

/// Certifies that every ball lies in the closed place of its zone, or in a piece of what lies in no zone; by
/// the same arithmetic as the certificate. `classes` of the spheres as `classes_of` counts them. Nothing
/// where the scene has no zones, where they are layers, and where the classes are not known. Throws as
/// `build` for places that are none. Cost: that of one certificate, and of cutting the container.
std::optional<ZonesInPlace> zones_in_place(const Scene&, const Domain&, const Spheres<dynamic>&,
                                           std::span<const std::uint32_t> classes,
                                           const CertifyOptions& options = {});

/// Certifies nothing where a sphere is misplaced, and says in the statement what was found.
void add_to(Certificate&, const ZonesInPlace&);

}  // namespace bernal
